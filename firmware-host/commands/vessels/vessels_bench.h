// octascope vessels bench: measures how long each method takes to draw a vessel tree on this
// machine, and checks the pictures.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware-host/commands/vessels/vessels_flight_bench.h"
#include "hal/result.h"
#include "pipeline/vessels/clusters.h"
#include "ui/vessels/pictures/vessel_methods.h"
#include "ui/vessels/quads/streamed_quads_method.h"
#include "ui/vessels/view/vessel_view.h"
#include "ui/view/segment_counts.h"

namespace octascope::firmware_host {

struct VesselBenchMethod {
  std::string name;
  ui::VesselMethodKind kind = ui::VesselMethodKind::hybrid;
  ui::ClusterChoice choice = ui::ClusterChoice::visible;
  bool occluded = false; // see ui::VesselLook
};
// All methods, "hybrid-occluded", and "quads-brute-force", the reference: quads drawn by GL with
// nothing culled.
const std::vector<VesselBenchMethod>& vessel_bench_methods();
inline constexpr std::string_view brute_force_name = "quads-brute-force";

struct VesselsBenchOptions {
  std::vector<std::string> methods; // empty: all
  std::vector<ui::BenchmarkView> views{ui::all_benchmark_views.begin(),
                                       ui::all_benchmark_views.end()};
  int width = 1280;
  int height = 720;
  double seconds = 3;                        // approximate time per method and view
  std::optional<std::filesystem::path> dump; // folder for the pictures
  // Also compare with brute-force quads sampled at four places within each pixel.
  bool supersampled = false;
  int flight_places = 0; // of a flight through the tree, by the hybrid and quads-gpu; 0: none
  std::function<void(std::string_view)> progress; // a line for each case; may be empty
};

struct VesselsBenchCase {
  std::string method;
  // Each with the camera turned a little further; only one where frames take seconds.
  int frames = 0;
  double ms_p50 = 0;
  double ms_p95 = 0;
  ui::SegmentCounts account;
  // Mean absolute difference over the picture, of 255, from quads-gpu and from the supersampled
  // quads.
  double difference = 0;
  std::optional<double> supersampled_difference;
  std::optional<ui::VesselShares> shares; // for `balanced` only
};

struct VesselsBenchView {
  ui::BenchmarkView what = ui::BenchmarkView::whole;
  ui::VesselView view;
  std::vector<VesselsBenchCase> cases;

  const VesselsBenchCase* find(std::string_view method) const;
};

struct VesselsBenchReport {
  std::string cpu;
  std::string gl_renderer;
  int width = 0;
  int height = 0;
  double upload_ms = 0; // of the nodes to GL, for methods that need it
  std::vector<VesselsBenchView> views;
  std::optional<VesselsFlightReport> flight;
};

// Opens an offscreen GL context for itself and closes it again; none may be current on this thread.
hal::Result<VesselsBenchReport> bench_vessels(const pipeline::VesselClusters& tree,
                                              const VesselsBenchOptions& options);

// Where the tree came from.
struct VesselsBenchTree {
  std::string source;
  std::uint64_t segments = 0;
  std::uint64_t bytes = 0; // of clusters, nodes and sources
  bool mapped = false;
  std::optional<double> load_ms;  // from the file to a drawable tree
  std::optional<double> build_ms; // from a tree in memory to clusters
};

std::string to_json(const VesselsBenchTree& tree, const VesselsBenchReport& report);
std::string to_text(const VesselsBenchTree& tree, const VesselsBenchReport& report);

} // namespace octascope::firmware_host
