// A tree's nodes where shaders find them.
#pragma once

#include "hal/result.h"
#include "pipeline/vessels/clusters.h"
#include "ui/gl/objects.h"
#include "ui/vessels/scene/tree_key.h"

namespace octascope::ui {

// Eight bytes a node, in layers of one texture: GLES guarantees 2048 texels along a side and 256
// layers, and neither buffer textures nor storage buffers in the vertex stage. Of 19 bits of a
// node's index the lowest 11 are its column and the others its row; those above are its layer.
//
// Threads: as gl/objects.h.
class NodeTexture {
public:
  // Copies the nodes when it has not shown them last: told by where and how many they are, and by a
  // sample of them. ErrorCode::system: the driver has no room for them.
  hal::Result<> show(const pipeline::VesselClusters& tree);

  const TreeKey& shown() const { return key_; }

  // GL_TEXTURE_2D_ARRAY, RG32UI.
  void bind(GLenum unit) const;

private:
  gl::Texture texture_;
  TreeKey key_;
};

} // namespace octascope::ui
