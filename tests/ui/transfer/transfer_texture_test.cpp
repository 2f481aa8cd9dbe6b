// The transfer function on its way to the shaders.
#include <array>
#include <memory>
#include <vector>

#include "tests/ui/support/gl_test.h"
#include "ui/transfer/transfer_texture.h"

namespace octascope::tests {
namespace {

class TransferTextureTest : public GlTest {
protected:
  // The texels as GL has them, RGBA, row after row.
  static std::vector<float> read(const ui::TransferTexture& texture) {
    using Texture = ui::TransferTexture;
    std::vector<float> texels(std::size_t{4} * Texture::width * Texture::height);
    GLint bound = 0;
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &bound);
    const auto framebuffer = ui::gl::Framebuffer::make();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.name(), 0);
    glReadPixels(0, 0, Texture::width, Texture::height, GL_RGBA, GL_FLOAT, texels.data());
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(bound));
    return texels;
  }

  std::unique_ptr<ui::TransferTable> table_ = std::make_unique<ui::TransferTable>();
};

TEST_F(TransferTextureTest, holds_every_entry_in_its_order) {
  for (std::size_t i = 0; i < ui::TransferTable::entries; ++i) {
    const auto v = static_cast<float>(i);
    table_->colour[i] = {v, v + 0.25F, v + 0.5F};
    table_->opacity[i] = v / ui::TransferTable::entries;
  }
  ui::TransferTexture texture;
  texture.update(*table_);
  const std::vector<float> texels = read(texture);
  for (std::size_t i = 0; i < ui::TransferTable::entries; ++i) {
    const auto v = static_cast<float>(i);
    ASSERT_EQ(texels[4 * i], v);
    ASSERT_EQ(texels[4 * i + 1], v + 0.25F);
    ASSERT_EQ(texels[4 * i + 2], v + 0.5F);
    ASSERT_EQ(texels[4 * i + 3], v / ui::TransferTable::entries);
  }
  EXPECT_FALSE(texture.window());
}

TEST_F(TransferTextureTest, uploads_only_what_has_changed) {
  GLint widest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &widest);
  EXPECT_LE(ui::TransferTexture::width, 2048) << "what GL ES 3.0 promises";
  EXPECT_LE(ui::TransferTexture::width, widest);
  ui::TransferTexture texture;
  EXPECT_EQ(texture.version(), 0U);
  texture.update(*table_);
  EXPECT_EQ(texture.version(), 1U) << "a first one, even if all is zero";
  ui::ViewState view;
  ui::make_window_table(view, *table_);
  texture.update(*table_);
  texture.update(*table_);
  EXPECT_EQ(texture.version(), 2U);
  table_->colour[4000].blue += 0.01F;
  texture.update(*table_);
  EXPECT_EQ(texture.version(), 3U);
  table_->window.reset(); // the shader is another one
  texture.update(*table_);
  EXPECT_EQ(texture.version(), 4U);
  EXPECT_EQ(read(texture)[4 * 4000 + 2], table_->colour[4000].blue);
}

TEST(VisibleLevels, counts_the_neighbours_of_who_interpolates) {
  const auto table = std::make_unique<ui::TransferTable>();
  constexpr int per_level = ui::TransferTable::entries_per_level;
  table->opacity[100 * per_level + 1] = 0.5F; // a sixteenth above level 100
  ui::VisibleLevels levels;
  ui::find_visible_levels(*table, levels);
  EXPECT_TRUE(levels.empty(0, 100));
  EXPECT_FALSE(levels.empty(0, 101));
  EXPECT_FALSE(levels.empty(100, 101));
  EXPECT_TRUE(levels.empty(101, 255));
  levels.margin = 1;
  EXPECT_FALSE(levels.empty(0, 100));
  EXPECT_TRUE(levels.empty(0, 99));
  EXPECT_TRUE(levels.empty(101, 255));
}

} // namespace
} // namespace octascope::tests
