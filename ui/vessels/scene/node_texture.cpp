#include "ui/vessels/scene/node_texture.h"

#include <algorithm>

namespace octascope::ui {

namespace {

constexpr std::size_t columns = 2048;
constexpr std::size_t rows = 256;
constexpr std::size_t layer_nodes = columns * rows;
constexpr std::size_t most_layers = 256;

void upload(std::size_t first_row, std::size_t width, std::size_t height,
            const pipeline::PackedNode* nodes) {
  glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, static_cast<GLint>(first_row % rows),
                  static_cast<GLint>(first_row / rows), static_cast<GLsizei>(width),
                  static_cast<GLsizei>(height), 1, GL_RG_INTEGER, GL_UNSIGNED_INT, nodes);
}

} // namespace

hal::Result<> NodeTexture::show(const pipeline::VesselClusters& tree) {
  const TreeKey key = tree_key(tree);
  if (texture_ && key == key_)
    return {};
  const std::size_t count = tree.nodes.size();
  if (count > layer_nodes * most_layers)
    return hal::fail(hal::ErrorCode::system,
                     "vessels: found {} nodes, expected at most {}; draw a part of the tree", count,
                     layer_nodes * most_layers);
  const std::size_t all_rows = std::max<std::size_t>(1, (count + columns - 1) / columns);
  const std::size_t layers = (all_rows + rows - 1) / rows;
  texture_ = {}; // before the new one: both together may not fit
  texture_ = gl::Texture::make();
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.name());
  while (glGetError() != GL_NO_ERROR) // of others
    ;
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_RG32UI, columns,
                 static_cast<GLsizei>(std::min(rows, all_rows)), static_cast<GLsizei>(layers));
  if (glGetError() != GL_NO_ERROR) {
    texture_ = {};
    return hal::fail(hal::ErrorCode::system,
                     "vessels: the graphics driver has no room for a texture of {} MB; draw by the "
                     "processor, or a smaller tree",
                     layers * layer_nodes * sizeof(pipeline::PackedNode) / 1'000'000);
  }
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  const std::size_t full_rows = count / columns;
  for (std::size_t row = 0; row < full_rows; row += rows)
    upload(row, columns, std::min(rows, full_rows - row), tree.nodes.data() + row * columns);
  if (const std::size_t rest = count % columns; rest > 0)
    upload(full_rows, rest, 1, tree.nodes.data() + full_rows * columns);
  key_ = key;
  return {};
}

void NodeTexture::bind(GLenum unit) const {
  glActiveTexture(unit);
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.name());
}

} // namespace octascope::ui
