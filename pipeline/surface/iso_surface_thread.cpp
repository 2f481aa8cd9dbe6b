#include "pipeline/surface/iso_surface_thread.h"

#include <utility>

namespace octascope::pipeline {

namespace {

// A blob of 0.1 mm across: less is speckle that smoothing left.
constexpr float least_piece_mm2 = 0.03F;

// The brightest of many samples is speckle, unless it is calm: by averaging, else by smoothing, although
// that takes away what is bright and thin.
constexpr int least_voxels = 8;

} // namespace

IsoSurfaceThread::IsoSurfaceThread(int first_depth, ThreadSetup setup)
    : first_depth_{first_depth}, setup_{std::move(setup)} {}

void IsoSurfaceThread::show(const Volume& volume, const Cover& cover, std::uint64_t of) {
  maker_.make(volume, first_depth_, shown_pool_[filling_].grid);
  shown_pool_[filling_].cover = cover;
  shown_pool_[filling_].of = of;
  filling_ = grids_.publish(filling_).recycled;
  ++shown_;
}

void IsoSurfaceThread::request(float level) {
  if (shown_ == 0 || (asked_of_ == shown_ && asked_level_ == level))
    return;
  asked_of_ = shown_;
  asked_level_ = level;
  level_.store(level, std::memory_order_relaxed);
  requested_.fetch_add(1, std::memory_order_release);
  if (!thread_.started())
    thread_.start({"surface"}, setup_, [this] { run(); });
  wakeup_.post();
}

const IsoMesh* IsoSurfaceThread::take_newest() {
  const auto newest = meshes_.take();
  return newest ? &mesh_pool_[*newest] : nullptr;
}

void IsoSurfaceThread::wait() const {
  const std::uint64_t newest = requested_.load(std::memory_order_relaxed);
  for (std::uint64_t done = finished_.load(std::memory_order_acquire); done != newest;
       done = finished_.load(std::memory_order_acquire))
    finished_.wait(done, std::memory_order_acquire);
}

void IsoSurfaceThread::run() {
  while (!thread_.stopping()) {
    serve();
    wakeup_.wait();
  }
}

void IsoSurfaceThread::serve() {
  bool must_finish = false;
  while (!thread_.stopping()) {
    const std::uint64_t request = requested_.load(std::memory_order_acquire);
    if (request == finished_.load(std::memory_order_relaxed))
      return;
    const bool made = make_mesh(request, must_finish);
    must_finish = !made;
    if (!made) {
      abandoned_.fetch_add(1, std::memory_order_relaxed);
      continue;
    }
    making_ = meshes_.publish(making_).recycled;
    finished_.store(request, std::memory_order_release);
    finished_.notify_all();
  }
}

// False when it was given up.
bool IsoSurfaceThread::make_mesh(std::uint64_t request, bool must_finish) {
  const auto superseded = [&] {
    return thread_.stopping() ||
           (!must_finish && requested_.load(std::memory_order_relaxed) != request);
  };
  if (grids_.take())
    smooth_ = false;
  auto& [grid, cover, of] = shown_pool_[grids_.front()];
  if (!smooth_) {
    // Another level of the same volume needs the smoothing all the same.
    const auto outdated = [&] {
      return superseded() && (grids_.has_newer() || thread_.stopping());
    };
    look_.keep(grid);
    if (!smoother_.smooth(grid, outdated))
      return false;
    if (grid.voxels < least_voxels)
      look_.keep(grid);
    update_occupancy(grid, occupancy_, counts_);
    smooth_ = true;
  }
  IsoMesh& mesh = mesh_pool_[making_];
  if (!extractor_.extract(grid, occupancy_, level_.load(std::memory_order_relaxed), mesh,
                          superseded))
    return false;
  cleaner_.drop_small_pieces(least_piece_mm2, mesh);
  look_.tell(grid, cover, mesh);
  mesh.of = of;
  return true;
}

} // namespace octascope::pipeline
