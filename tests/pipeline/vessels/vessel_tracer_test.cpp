// Trees to flow volumes and back: how far centrelines are off, what is found, what is invented.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <stop_token>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include "pipeline/vessels/tracing/vessel_tracer.h"
#include "pipeline/vessels/tree_comparison.h"
#include "pipeline/vessels/tree_summary.h"
#include "pipeline/volume/flow_scale.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/vessels/flow_scene.h"

namespace octascope::pipeline {
namespace {

using tests::add_line;
using tests::add_tube;
using tests::flow_of;
using tests::FlowFlaws;
using tests::oct_geometry;

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr double full_turn = 2 * std::numbers::pi;

// 2 mm along A-scans, 1.9 mm along B-scans, 1.1 mm deep.
const VolumeGeometry field = oct_geometry(320, 200, 50);

// What an angiogram has: 2 % of static tissue and some clusters called flowing, a tenth of vessels
// not, tails, and places where nothing can be told.
const FlowFlaws flaws{.spread = 0.15F,
                      .salt = 0.02,
                      .clusters = 6,
                      .holes = 0.1,
                      .unknown = 0.05,
                      .tail = 0.3F,
                      .tail_um = 60};

// Along A-scans, along B-scans, along the depth, and aslant, in layers that do not touch.
VesselTree tubes(double radius_um) {
  VesselTree tree;
  add_tube(tree, {0, 300, 180}, {2000, 420, 240}, radius_um);
  add_tube(tree, {500, 600, 500}, {350, 1875, 440}, radius_um);
  add_tube(tree, {1000, 750, 800}, {1900, 1700, 950}, radius_um);
  add_tube(tree, {1600, 800, 300}, {1650, 850, 700}, radius_um);
  add_tube(tree, {200, 200, 600}, {1400, 700, 900}, radius_um);
  return tree;
}

VesselTree forks(double radius_um) {
  VesselTree tree;
  const auto trunk = add_tube(tree, {0, 950, 550}, {700, 950, 550}, radius_um);
  const auto left = add_tube(tree, {700, 950, 550}, {1300, 550, 480}, radius_um * 0.8, trunk);
  const auto right = add_tube(tree, {700, 950, 550}, {1300, 1350, 650}, radius_um * 0.8, trunk);
  add_tube(tree, {1300, 550, 480}, {2000, 550, 450}, radius_um * 0.64, left);
  add_tube(tree, {1300, 550, 480}, {1700, 0, 600}, radius_um * 0.64, left);
  add_tube(tree, {1300, 1350, 650}, {2000, 1200, 800}, radius_um * 0.64, right);
  add_tube(tree, {1300, 1350, 650}, {1700, 1875, 650}, radius_um * 0.64, right);
  return tree;
}

// Three helices, one around each axis.
VesselTree helices(double radius_um) {
  VesselTree tree;
  const double wide = 3 * radius_um;
  const double turn = 20 * radius_um;
  add_line(
      tree,
      [&](double t) {
        const double phase = full_turn * t * 1800 / turn;
        return Point{100 + 1800 * t, 350 + wide * std::cos(phase), 300 + wide * std::sin(phase)};
      },
      radius_um, no_parent, 200);
  add_line(
      tree,
      [&](double t) {
        const double phase = full_turn * t * 1600 / turn;
        return Point{1500 + wide * std::cos(phase), 150 + 1600 * t, 800 + wide * std::sin(phase)};
      },
      radius_um, no_parent, 200);
  add_line(
      tree,
      [&](double t) {
        const double phase = full_turn * t * 800 / turn;
        return Point{600 + wide * std::cos(phase), 1300 + wide * std::sin(phase), 150 + 800 * t};
      },
      radius_um, no_parent, 100);
  return tree;
}

VesselTree winding(double radius_um) {
  VesselTree tree;
  for (int i = 0; i < 5; ++i)
    add_line(
        tree,
        [&](double t) {
          return Point{2000 * t, 200 + 350 * i + 5 * radius_um * std::sin(10 * t + i),
                       300 + 100 * i + 3 * radius_um * std::sin(14 * t)};
        },
        radius_um, no_parent, 150);
  return tree;
}

// Pairs whose walls are 40 µm apart, one above the other and side by side.
VesselTree pairs(double radius_um) {
  VesselTree tree;
  const double apart = 2 * radius_um + 40;
  add_tube(tree, {0, 500, 200}, {2000, 560, 220}, radius_um);
  add_tube(tree, {0, 500, 200 + apart}, {2000, 560, 220 + apart}, radius_um);
  add_tube(tree, {500, 100, 700}, {560, 1875, 720}, radius_um);
  add_tube(tree, {500 + apart, 100, 700}, {560 + apart, 1875, 720}, radius_um);
  return tree;
}

struct Scene {
  const char* name;
  VesselTree (*tree)(double radius_um);
  double radius_um;
};

void PrintTo(const Scene& scene, std::ostream* out) {
  *out << scene.name << " of " << scene.radius_um << " µm";
}

class VesselTracerScenes : public testing::TestWithParam<Scene> {};

// Wide enough for the limits below to fail; what is farther away counts as invented.
TreeComparison compare(const TracedVessels& traced, const VesselTree& truth, double radius_um) {
  return compare_trees(traced.tree, truth,
                       {.tolerance_mm = static_cast<float>(std::max(0.1, 2e-3 * radius_um))});
}

// The figures: 15 µm across depth and A-scans, 55 µm across B-scans, 90 % found, 5 % invented.
TEST_P(VesselTracerScenes, finds_centrelines_within_voxels) {
  const Scene& scene = GetParam();
  const VesselTree truth = scene.tree(scene.radius_um);
  const auto traced = VesselTracer{}.trace(field, flow_of(truth, field, flaws));
  ASSERT_TRUE(traced) << traced.error().message;
  ASSERT_EQ(traced->refusal, "");
  const TreeComparison found = compare(*traced, truth, scene.radius_um);
  fmt::print("{:8} {:3.0f} µm: A {:5.1f} B {:5.1f} depth {:5.1f} µm (p95), found {:.3f}, invented "
             "{:.3f}, radius {:+.2f}, quality {:.2f}\n",
             scene.name, scene.radius_um, found.axes[0].p95_um, found.axes[1].p95_um,
             found.axes[2].p95_um, found.found_share, found.invented_share, found.radius_bias_share,
             traced->quality);
  EXPECT_LE(found.axes[0].p95_um, 15);
  EXPECT_LE(found.axes[1].p95_um, 55);
  EXPECT_LE(found.axes[2].p95_um, 15);
  EXPECT_GE(found.found_share, 0.9);
  EXPECT_LE(found.invented_share, 0.05);
  EXPECT_NEAR(found.radius_bias_share, 0, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Scenes, VesselTracerScenes,
                         testing::Values(Scene{"tubes", tubes, 20}, Scene{"tubes", tubes, 30},
                                         Scene{"tubes", tubes, 75}, Scene{"forks", forks, 30},
                                         Scene{"forks", forks, 75}, Scene{"helices", helices, 25},
                                         Scene{"helices", helices, 40},
                                         Scene{"winding", winding, 20},
                                         Scene{"winding", winding, 40}, Scene{"pairs", pairs, 20},
                                         Scene{"pairs", pairs, 40}));

// A live volume's counts are flow to 1/254, and what could not be told stays so.
TEST(VesselTracerTree, is_the_same_of_a_live_volumes_counts) {
  std::vector<std::uint8_t> counts;
  std::vector<float> flow = flow_of(forks(50), field, flaws);
  for (float& value : flow) {
    counts.push_back(quantise_flow(value));
    value = pipeline::flow_of(counts.back());
  }
  const auto of_counts = VesselTracer{}.trace(field, counts);
  const auto of_flow = VesselTracer{}.trace(field, flow);
  ASSERT_TRUE(of_counts && of_flow);
  ASSERT_EQ(of_counts->refusal, "");
  EXPECT_NEAR(of_counts->quality, of_flow->quality, 1e-4);
  EXPECT_EQ(of_counts->tree.parents, of_flow->tree.parents);
  ASSERT_EQ(of_counts->tree.nodes(), of_flow->tree.nodes());
  for (std::size_t node = 0; node < of_flow->tree.nodes(); ++node)
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(of_counts->tree.positions_mm[node][axis], of_flow->tree.positions_mm[node][axis],
                  1e-4);
}

TEST(VesselTracerTree, joins_branches_at_forks) {
  const VesselTree truth = forks(50);
  const auto traced = VesselTracer{}.trace(field, flow_of(truth, field));
  ASSERT_TRUE(traced);
  const TreeSummary summary = summarise(traced->tree);
  EXPECT_EQ(summary.roots, 1U);
  EXPECT_EQ(summary.branch_points, 3U);
  EXPECT_EQ(summary.tips, 4U);
  // The trunk is the widest end.
  EXPECT_LT(traced->tree.positions_mm[0][0], 0.1F);
  for (std::size_t node = 1; node < traced->tree.nodes(); ++node)
    EXPECT_LT(traced->tree.parents[node], node);
}

TEST(VesselTracerTree, bridges_a_gap_between_ends_that_point_at_each_other) {
  VesselTree truth;
  add_tube(truth, {0, 900, 500}, {900, 900, 500}, 40);
  add_tube(truth, {1090, 900, 500}, {2000, 900, 500}, 40);
  auto traced = VesselTracer{}.trace(field, flow_of(truth, field));
  ASSERT_TRUE(traced);
  EXPECT_EQ(summarise(traced->tree).roots, 1U);

  truth = {};
  add_tube(truth, {0, 900, 500}, {900, 900, 500}, 40);
  add_tube(truth, {1090, 800, 500}, {1090, 0, 500}, 40); // turns away
  traced = VesselTracer{}.trace(field, flow_of(truth, field));
  ASSERT_TRUE(traced);
  EXPECT_EQ(summarise(traced->tree).roots, 2U);
}

TEST(VesselTracerTree, reaches_across_missing_b_scans) {
  VesselTree truth;
  add_tube(truth, {900, 0, 500}, {1000, 1875, 560}, 40);
  FlowFlaws missing;
  missing.missing_every = 8;
  const auto traced = VesselTracer{}.trace(field, flow_of(truth, field, missing));
  ASSERT_TRUE(traced);
  const TreeComparison found = compare(*traced, truth, 40);
  EXPECT_EQ(summarise(traced->tree).roots, 1U);
  EXPECT_GE(found.found_share, 0.97);
  EXPECT_LE(found.axes[0].p95_um, 15);
}

TEST(VesselTracerTree, leaves_out_b_scans_that_moved) {
  const VesselTree truth = tubes(40);
  std::vector<float> flow = flow_of(truth, field);
  for (const std::size_t b : {7U, 20U, 21U, 40U})
    std::fill_n(flow.begin() + static_cast<std::ptrdiff_t>(b * field.b_scan_voxels()),
                field.b_scan_voxels(), 0.8F);
  const auto traced = VesselTracer{}.trace(field, flow);
  ASSERT_TRUE(traced);
  EXPECT_EQ(traced->refusal, "");
  EXPECT_EQ(traced->moved_b_scans, 4);
  const TreeComparison found = compare(*traced, truth, 40);
  EXPECT_GE(found.found_share, 0.9);
  EXPECT_LE(found.invented_share, 0.05);
}

TEST(VesselTracerTree, is_refused_where_nothing_has_the_shape_of_vessels) {
  const VolumeGeometry small = oct_geometry(200, 100, 24);
  const auto refusal = [&](const std::vector<float>& flow) {
    const auto traced = VesselTracer{}.trace(small, flow);
    EXPECT_TRUE(traced);
    EXPECT_EQ(traced->tree.nodes(), 0U);
    return traced->refusal;
  };
  EXPECT_EQ(refusal(std::vector<float>(small.voxels(), unknown)), "no flow is known");
  EXPECT_EQ(refusal(std::vector<float>(small.voxels(), 0.0F)), "no vessel was found");
  EXPECT_EQ(refusal(std::vector<float>(small.voxels(), 1.0F)),
            "24 of 24 B-scans flow as a whole: motion, not vessels");
  VolumeGeometry fine = small; // three B-scans together, and two in the last row
  fine.b_scans = 23;
  fine.b_spacing_um = 3.5;
  fine.depth_spacing_um = 10;
  EXPECT_EQ(VesselTracer{}.trace(fine, std::vector<float>(fine.voxels(), 1.0F))->refusal,
            "23 of 23 B-scans flow as a whole: motion, not vessels");
  FlowFlaws noise{.salt = 0.02};
  EXPECT_NE(refusal(flow_of({}, small, noise)), "");
  noise.clusters = 60;
  EXPECT_NE(refusal(flow_of({}, small, noise)), "");
  for (const double salt : {0.2, 0.3, 0.45, 0.6}) {
    noise.salt = salt;
    EXPECT_NE(refusal(flow_of({}, small, noise)), "") << salt;
  }
}

TEST(VesselTracerTree, comes_of_any_shape_and_content) {
  std::mt19937 random{tests::fresh_seed()};
  const auto below = [&](int most) { return std::uniform_int_distribution{0, most}(random); };
  constexpr std::array<int, 6> sizes{1, 2, 3, 5, 17, 60};
  for (int i = 0; i < 150; ++i) {
    VolumeGeometry g;
    g.depths = sizes[static_cast<std::size_t>(below(5))];
    g.a_scans = sizes[static_cast<std::size_t>(below(5))];
    g.b_scans = sizes[static_cast<std::size_t>(below(4))];
    g.depth_spacing_um = 1 + below(20);
    g.a_spacing_um = 1 + below(20);
    g.b_spacing_um = 1 + below(40);
    const int kind = below(5);
    std::vector<float> flow(g.voxels());
    float last = 0;
    for (float& value : flow) {
      if (below(kind * kind * 3) == 0)
        last = below(9) == 0 ? unknown : static_cast<float>(below(100)) / 100 * (below(2) == 0);
      value = last;
    }
    const auto traced = VesselTracer{}.trace(g, flow);
    ASSERT_TRUE(traced) << traced.error().message;
    for (const auto& at : traced->tree.positions_mm)
      for (const float c : at)
        ASSERT_TRUE(std::isfinite(c));
    for (const float radius : traced->tree.radii_mm)
      ASSERT_TRUE(std::isfinite(radius) && radius > 0);
  }
}

TEST(VesselTracerTree, is_refused_of_what_is_no_flow) {
  const VolumeGeometry small = oct_geometry(10, 10, 2);
  using tests::FailsWith;
  EXPECT_THAT(VesselTracer{}.trace(small, std::vector<float>(small.voxels(), 60.0F)),
              FailsWith(hal::ErrorCode::bad_data, "found values from 0 to 60, expected flow"));
  EXPECT_THAT(VesselTracer{}.trace(small, std::vector<float>(7)),
              FailsWith(hal::ErrorCode::invalid_argument, "found 7 values of flow"));
  EXPECT_THAT(VesselTracer{}.trace(oct_geometry(0, 10, 2), std::vector<float>{}),
              FailsWith(hal::ErrorCode::invalid_argument, "expected at least one of each"));
  EXPECT_THAT(
      VesselTracer{}.trace(oct_geometry(1, 40'000, 40'000), std::vector<float>{}),
      FailsWith(hal::ErrorCode::unsupported, "expected at most 4294967280: cut the volume"));
  VolumeGeometry flat = small;
  flat.a_spacing_um = 0;
  EXPECT_THAT(VesselTracer{}.trace(flat, std::vector<float>(small.voxels())),
              FailsWith(hal::ErrorCode::invalid_argument, "expected one above 0"));
}

// Of one thread, so that others on the machine do not count.
double processor_s(clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// By another thread, at tenths of the time that the whole takes.
TEST(VesselTracerTree, may_be_stopped) {
  const std::vector<float> flow = flow_of(winding(60), field);
  double begun = processor_s();
  ASSERT_TRUE(VesselTracer{}.trace(field, flow));
  const double whole = processor_s() - begun;
  clockid_t clock{};
  ASSERT_EQ(pthread_getcpuclockid(pthread_self(), &clock), 0);
  double longest = 0;
  for (int tenth = 1; tenth < 10; ++tenth) {
    std::stop_source source;
    double stopped = 0;
    begun = processor_s();
    {
      // It ends with the tracing, too, which may take less than the first one did: then this
      // thread waits for the other, and its clock stands still.
      const std::jthread other{[&](const std::stop_token& over) {
        while (!over.stop_requested() && processor_s(clock) < begun + whole * tenth / 10)
          std::this_thread::sleep_for(std::chrono::microseconds{200});
        stopped = processor_s(clock);
        source.request_stop();
      }};
      const auto traced = VesselTracer{}.trace(field, flow, source.get_token());
      EXPECT_TRUE(traced);
    }
    longest = std::max(longest, processor_s() - stopped);
  }
  EXPECT_LT(longest, whole / 2);
}

TEST(VesselTracerTree, finds_nothing_once_it_is_stopped) {
  std::stop_source source;
  source.request_stop();
  const auto traced = VesselTracer{}.trace(field, flow_of(tubes(60), field), source.get_token());
  ASSERT_TRUE(traced);
  EXPECT_EQ(traced->tree.nodes(), 0U);
  EXPECT_NE(traced->refusal, "");
}

// Of other shapes, of less that flows, or stopped on the way.
TEST(VesselTracerTree, is_the_same_whatever_the_tracer_traced_before) {
  const std::vector<float> flow = flow_of(winding(60), field);
  const VesselTree alone = VesselTracer{}.trace(field, flow)->tree;
  const VolumeGeometry larger =
      oct_geometry(field.depths + 7, field.a_scans + 5, field.b_scans + 3);
  VesselTracer tracer;
  std::stop_source source;
  source.request_stop();
  for (const auto& before : std::vector<std::function<hal::Result<TracedVessels>()>>{
           [&] { return tracer.trace(larger, std::vector<float>(larger.voxels(), 1.0F)); },
           [&] { return tracer.trace(field, std::vector<float>(field.voxels())); },
           [&] { return tracer.trace(field, flow, source.get_token()); },
           [&] { return tracer.trace(field, std::vector<float>(7)); },
           [&] { return tracer.trace(field, flow); }}) {
    static_cast<void>(before());
    const auto traced = tracer.trace(field, flow);
    EXPECT_EQ(traced->tree.positions_mm, alone.positions_mm);
    EXPECT_EQ(traced->tree.radii_mm, alone.radii_mm);
    EXPECT_EQ(traced->tree.parents, alone.parents);
    EXPECT_EQ(traced->moved_b_scans, 0);
  }
}

// Prints what a whole volume costs; the bound is wide, since tests share the machine.
TEST(VesselTracerTree, takes_less_than_three_seconds_of_one_core) {
  const VolumeGeometry g = oct_geometry(512, 300, 80);
  VesselTree truth;
  std::mt19937_64 random{3};
  std::uniform_real_distribution<double> share{0, 1};
  for (int i = 0; i < 24; ++i) {
    const Point from{0, 100 + 2800 * share(random), 100 + 1600 * share(random)};
    const Point to{3000, 100 + 2800 * share(random), 100 + 1600 * share(random)};
    const double wave = 60 + 100 * share(random);
    add_line(
        truth,
        [&](double t) {
          return Point{3000 * t, from[1] + t * (to[1] - from[1]) + wave * std::sin(8 * t),
                       from[2] + t * (to[2] - from[2]) + wave * std::cos(7 * t)};
        },
        30 + 70 * share(random), no_parent, 150);
  }
  const std::vector<float> flow = flow_of(truth, g, flaws);
  double least = std::numeric_limits<double>::infinity();
  TracedVessels traced;
  for (int turn = 0; turn < 2; ++turn) {
    const double begun = processor_s();
    traced = *VesselTracer{}.trace(g, flow);
    least = std::min(least, processor_s() - begun);
  }
  fmt::print("512×300×80 voxels, {:.1f} mm of vessels: {:.2f} s of one core\n",
             summarise(traced.tree).length_mm, least);
  EXPECT_EQ(traced.refusal, "");
#ifdef NDEBUG
  EXPECT_LT(least, 3.0);
#endif
}

} // namespace
} // namespace octascope::pipeline
