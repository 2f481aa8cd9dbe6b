// The iso-surface, as a solid: where the level passes a quarter of the display window.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "hal/result.h"
#include "pipeline/surface/iso_surface_thread.h"
#include "ui/gl/objects.h"
#include "ui/gl/program.h"
#include "ui/transfer/transfer_set.h"
#include "ui/volume/volume_technique.h"

namespace octascope::ui {

// The level of a view's surface, as a count. Smoothing has calmed the noise, so that no confetti
// comes of a level near it; at the middle of the window thin layers and an instrument's metal,
// which smoothing darkens, would be left out where every other technique shows them.
float surface_level(const ViewState& view);

inline constexpr float surface_ambient = 0.35F; // of the lamp at the eye's light

// Where in the window's colours those of tissue and of metal are taken from: tissue's is dark enough to
// show its light and shade and what lies on it. Metal is what is well above the window.
inline constexpr float surface_tissue = 0.53F;
inline constexpr float surface_metal = 1;

inline constexpr float surface_flow_mm = 0.5F; // how deep below the surface flow is painted on it

// A separate thread makes the mesh (pipeline/surface/iso_surface_thread.h). Until a new mesh is
// finished, for a new volume or a changed window, the last one is drawn; before the first, nothing.
// A picture depends on the number that prepare() returns, and must be redrawn once has_newer() is
// true.
//
// What covers other tissue (pipeline/volume/cover.h) is glass, the clearer the more the view sees through
// and the surer it is that it covers. Nothing of a scene's volume is looked at: where the mesh is, how bright
// and what covers is all of the same volume.
//
// Flow, of a scene that has it, is painted on the surface: what flows below it, along the depth, by up to
// surface_flow_mm. It is that of the scene's volume, which may be newer than the mesh.
//
// The framebuffer needs a depth attachment of at least 16 bits, which draw() clears; without one,
// far parts are drawn over near ones.
//
// Threads: as gl/objects.h, apart from its own thread. draw() allocates nothing of its own.
class SurfaceTechnique final : public VolumeTechnique {
public:
  // `threads` is called on the thread that makes the meshes.
  // ErrorCode::unsupported: this GL cannot compile the shaders.
  static hal::Result<std::unique_ptr<SurfaceTechnique>> create(TransferSet transfers = {},
                                                               pipeline::ThreadSetup threads = {});

  // Copies what it needs before it returns: two milliseconds for a live volume. `cover`: the volume's,
  // empty where nothing is seen through.
  void show(const pipeline::Volume& volume, const pipeline::Cover& cover = {}) {
    thread_.show(volume, cover);
  }

  // Requests the view's surface of the newest volume, takes the newest finished mesh and returns
  // its number. draw() does the same and draws that mesh.
  std::uint64_t prepare(const ViewState& view);
  // Whether prepare() would take another mesh.
  bool has_newer() const { return thread_.has_newer(); }
  // Waits until draw() will show the view's surface of the newest volume: for commands and tests.
  void finish(const ViewState& view);

  // To be called before scenes with flow are drawn. ErrorCode::unsupported: as create().
  hal::Result<> prepare_flow();

  // Of the mesh taken last.
  std::size_t triangles() const { return corners_ / 3; }

private:
  struct Drawn {
    explicit Drawn(gl::Program of);
    gl::Program program;
    GLint view_projection, eye, forward, extents, colour, metal, ambient, cue, cue_loss, cut_away,
        glass;
  };
  SurfaceTechnique(gl::Program program, TransferSet transfers, pipeline::ThreadSetup threads);
  void do_draw(const VolumeScene& scene) override;
  bool do_writes_depth() const override { return true; }
  void upload(const pipeline::IsoMesh& mesh);
  void set_uniforms(const Drawn& drawn, const VolumeScene& scene) const;
  void draw_mesh(const Drawn& drawn, bool glass) const;

  pipeline::IsoSurfaceThread thread_;
  TransferSet transfers_;
  Drawn plain_;
  std::optional<Drawn> with_flow_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertices_;
  gl::Buffer indices_;
  std::size_t corners_ = 0;
  bool covers_ = false;     // the mesh has glass
  std::uint64_t mesh_ = 0;  // counts the meshes taken
  glm::vec3 extents_mm_{0}; // of the mesh's volume: fast, depth, slow
};

} // namespace octascope::ui
