// Takes surfaces from volumes beside the render thread.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "pipeline/surface/iso_grid.h"
#include "pipeline/surface/iso_look.h"
#include "pipeline/surface/iso_surface.h"
#include "pipeline/threads/role_thread.h"
#include "pipeline/threads/triple_buffer.h"
#include "pipeline/threads/wakeup.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

// The render thread makes a small copy of each volume (its own only until it takes the next one),
// asks for a surface of some level, and takes the newest mesh that is finished; it never waits. The
// thread begins with the first request. A newer request makes it give up what it is at, from one
// slab to the next; but never twice in a row, so that meshes keep coming however fast the requests
// do. Smoothing is done once a volume: another level begins where it ended.
class IsoSurfaceThread {
public:
  // Depth bins before `first_depth` are left out.
  explicit IsoSurfaceThread(int first_depth, ThreadSetup setup = {});

  // All of these: the render thread.

  // Copies what it needs before it returns; some two milliseconds for a live volume. `cover`: the
  // volume's, empty where nothing is seen through. `of`: a number that its meshes have.
  void show(const Volume& volume, const Cover& cover = {}, std::uint64_t of = 0);
  // Of the volume shown last. Nothing happens when that has been asked for already.
  void request(float level);
  // The newest mesh, if one was finished since the last call; it stays, unchanged, until the next
  // call that returns one.
  const IsoMesh* take_newest();
  // Would take_newest() return one?
  bool has_newer() const { return meshes_.has_newer(); }
  // Waits until the newest request is fulfilled: for commands and tests.
  void wait() const;

  // Any thread. Requests that were given up for a newer one.
  std::uint64_t abandoned() const { return abandoned_.load(std::memory_order_relaxed); }

private:
  void run();
  void serve();
  bool make_mesh(std::uint64_t request, bool must_finish);

  struct Shown {
    IsoGrid grid;
    Cover cover;
    std::uint64_t of = 0;
  };

  const int first_depth_;
  const ThreadSetup setup_;

  // The render thread's.
  IsoGridMaker maker_;
  std::uint32_t filling_ = 2; // of shown_pool_
  std::uint64_t shown_ = 0;   // counts volumes
  std::uint64_t asked_of_ = 0;
  float asked_level_ = 0;

  // Handed over.
  std::array<Shown, 3> shown_pool_;
  TripleBuffer grids_{1, 0};
  std::array<IsoMesh, 3> mesh_pool_;
  TripleBuffer meshes_{1, 0};
  std::atomic<float> level_{0};
  std::atomic<std::uint64_t> requested_{0};
  std::atomic<std::uint64_t> finished_{0};
  std::atomic<std::uint64_t> abandoned_{0};
  Wakeup wakeup_;

  // The thread's.
  IsoSmoother smoother_;
  IsoExtractor extractor_;
  IsoCleaner cleaner_;
  IsoLook look_;
  Occupancy occupancy_;
  std::vector<std::uint8_t> counts_;
  bool smooth_ = false;      // the front grid is
  std::uint32_t making_ = 2; // of mesh_pool_
  RoleThread thread_{&wakeup_};
};

} // namespace octascope::pipeline
