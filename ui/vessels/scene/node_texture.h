// A tree's nodes in a texture for shaders.
#pragma once

#include "hal/result.h"
#include "pipeline/vessels/clusters.h"
#include "ui/gl/objects.h"
#include "ui/vessels/scene/tree_key.h"

namespace octascope::ui {

// Eight bytes per node, in layers of one texture: GLES guarantees 2048 texels per side and 256
// layers, but neither buffer textures nor storage buffers in the vertex stage. Of a node's index,
// bits 0–10 are its column, bits 11–18 its row, and the higher bits its layer.
//
// Threads: as gl/objects.h.
class NodeTexture {
public:
  // Uploads the nodes unless they are the ones shown last, which is judged by their address, number
  // and a sample. ErrorCode::system: the driver has no memory for them.
  hal::Result<> show(const pipeline::VesselClusters& tree);

  const TreeKey& shown() const { return key_; }

  // GL_TEXTURE_2D_ARRAY, RG32UI.
  void bind(GLenum unit) const;

private:
  gl::Texture texture_;
  TreeKey key_;
};

} // namespace octascope::ui
