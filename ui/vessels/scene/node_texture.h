// A tree's nodes in a texture for shaders.
#pragma once

#include "hal/result.h"
#include "pipeline/vessels/clusters.h"
#include "ui/gl/objects.h"
#include "ui/vessels/scene/tree_key.h"

namespace octascope::ui {

// Eight bytes a node, in layers of one texture: GLES guarantees 2048 texels along a side and 256
// layers, but neither buffer textures nor storage buffers in the vertex stage. In a node's index
// the lowest 11 bits are its column, the next 8 its row, the higher ones its layer.
//
// Threads: as gl/objects.h.
class NodeTexture {
public:
  // Copies the nodes unless they are the last ones shown, recognised by address, number and a
  // sample. ErrorCode::system: the driver has no memory for them.
  hal::Result<> show(const pipeline::VesselClusters& tree);

  const TreeKey& shown() const { return key_; }

  // GL_TEXTURE_2D_ARRAY, RG32UI.
  void bind(GLenum unit) const;

private:
  gl::Texture texture_;
  TreeKey key_;
};

} // namespace octascope::ui
