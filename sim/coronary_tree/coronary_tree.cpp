#include "sim/coronary_tree/coronary_tree.h"

#include <atomic>
#include <thread>

#include "sim/coronary_tree/heart/main_courses.h"
#include "sim/coronary_tree/myocardium_voxels.h"
#include "sim/coronary_tree/spacing/relaxation.h"
#include "sim/coronary_tree/tree_layout.h"
#include "sim/coronary_tree/trunk_growth.h"
#include "sim/coronary_tree/trunk_spacing.h"
#include "sim/coronary_tree/twig_growth.h"
#include "sim/spectrometer/noise.h"

namespace octascope::sim {
namespace {

enum class Purpose : std::uint64_t { plan = 1, course, trunk, layout, twig, places };

std::uint64_t key_of(std::uint64_t seed, Purpose purpose, std::size_t branch = 0) {
  return hash(seed, static_cast<std::uint64_t>(purpose), branch);
}

// The large vessels of the three arteries: what a seed gives whatever the number of segments.
struct Trunks {
  std::array<TrunkPlan, 3> plans;
  std::array<GrownTrunk, 3> grown;
  std::vector<Vector3> cells;
  std::array<std::size_t, 3> first_cell{};
};

Trunks grow_trunks(std::uint64_t seed, std::size_t threads) {
  Trunks trunks;
  std::array<double, 3> shares{};
  double all = 0;
  for (std::size_t b = 0; b < 3; ++b) {
    const BranchMorphometry& facts = morphometry(coronary_branches[b]);
    trunks.plans[b] = plan_trunk(facts, crown_sizes(facts, {}), key_of(seed, Purpose::plan, b));
    all += shares[b] = trunks.plans[b].elements[0].weight;
  }
  for (double& share : shares)
    share /= all;
  const auto course = [&](std::size_t b) {
    return main_course(coronary_branches[b], key_of(seed, Purpose::course, b));
  };
  const std::array<Course, 3> courses{course(0), course(1), course(2)};
  trunks.cells = myocardium_voxels();
  const auto counts = share_out(trunks.cells, courses, shares);
  std::size_t first = 0;
  for (std::size_t b = 0; b < 3; ++b) {
    trunks.first_cell[b] = first;
    trunks.grown[b] =
        grow_trunk(morphometry(coronary_branches[b]), trunks.plans[b], courses[b],
                   Region{trunks.cells}.subspan(first, counts[b]), key_of(seed, Purpose::trunk, b));
    first += counts[b];
  }
  space_trunks(trunks.plans, trunks.grown, threads);
  return trunks;
}

void resize(pipeline::VesselTree& tree, std::size_t nodes) {
  tree.positions_mm.resize(nodes);
  tree.radii_mm.resize(nodes);
  tree.parents.resize(nodes);
  tree.orders.resize(nodes);
  tree.branches.resize(nodes);
}

void write_node(pipeline::VesselTree& tree, std::uint32_t node, std::uint32_t parent,
                const TrunkNode& what, std::size_t order, pipeline::VesselBranch branch) {
  tree.positions_mm[node] = {static_cast<float>(what.place.x), static_cast<float>(what.place.y),
                             static_cast<float>(what.place.z)};
  tree.radii_mm[node] = static_cast<float>(what.diameter_um / 2000);
  tree.parents[node] = parent;
  tree.orders[node] = static_cast<std::uint8_t>(order);
  tree.branches[node] = branch;
}

// After a segment come the subtrees that spring off at its end, then the next one.
void write_trunk(const TrunkPlan& plan, const GrownTrunk& grown,
                 const std::vector<LaidOutElement>& layout, std::size_t index,
                 pipeline::VesselBranch branch, pipeline::VesselTree& tree) {
  const PlannedElement& element = plan.elements[index];
  std::uint32_t node = layout[index].node;
  std::uint32_t parent = layout[index].parent;
  for (std::uint32_t k = 0; k < layout[index].own; ++k) {
    write_node(tree, node, parent, grown.nodes[grown.elements[index].first_node + k], element.order,
               branch);
    parent = node++;
    for (std::uint32_t i = 0; i < element.daughters; ++i)
      if (plan.elements[element.first_daughter + i].joint == k)
        node += layout[element.first_daughter + i].all;
  }
}

struct TwigJob {
  std::size_t branch;
  std::uint32_t element;
};

class TwigWork {
public:
  TwigWork(const Trunks& trunks, const TreeLayout& layout, std::uint64_t seed,
           pipeline::VesselTree& tree)
      : trunks_{trunks}, layout_{layout}, seed_{seed}, tree_{tree} {
    for (std::size_t b = 0; b < 3; ++b) {
      const BranchMorphometry& facts = morphometry(coronary_branches[b]);
      rules_[b] = {coronary_branches[b], &facts, layout.low, crown_sizes(facts, layout.low)};
      for (std::uint32_t i = 0; i < layout.branches[b].size(); ++i)
        if (!trunks.plans[b].elements[i].is_trunk() && layout.branches[b][i].all > 0)
          jobs_.push_back({b, i});
    }
  }

  // Takes jobs until there are none; several threads may. `progress` may be empty.
  void work(const std::function<void(double)>& progress) {
    constexpr std::size_t batch = 64;
    for (std::size_t first = 0; (first = next_.fetch_add(batch)) < jobs_.size();) {
      for (std::size_t i = first; i < std::min(first + batch, jobs_.size()); ++i)
        grow(jobs_[i]);
      if (progress)
        progress(static_cast<double>(first) / static_cast<double>(jobs_.size()));
    }
  }

private:
  void grow(const TwigJob& job) {
    const GrownElement& grown = trunks_.grown[job.branch].elements[job.element];
    const LaidOutElement& laid_out = layout_.branches[job.branch][job.element];
    const auto cells = std::span{trunks_.cells}.subspan(
        trunks_.first_cell[job.branch] + grown.first_cell, grown.cells);
    // About as many places as there are ends.
    const std::size_t count = std::max<std::size_t>(cells.size(), laid_out.all / 2);
    std::vector<Vector3> places = places_in_cells(
        cells, count, hash(key_of(seed_, Purpose::places, job.branch), job.element));
    Twig twig;
    twig.order = trunks_.plans[job.branch].elements[job.element].order;
    twig.segments = laid_out.all;
    twig.node = laid_out.node;
    twig.parent = laid_out.parent;
    twig.start = grown.start;
    twig.direction = grown.direction;
    twig.mother_um = grown.mother_um;
    twig.region = places;
    grow_twig(rules_[job.branch], twig, hash(key_of(seed_, Purpose::twig, job.branch), job.element),
              tree_);
  }

  const Trunks& trunks_;
  const TreeLayout& layout_;
  std::uint64_t seed_;
  pipeline::VesselTree& tree_;
  std::array<TwigRules, 3> rules_;
  std::vector<TwigJob> jobs_;
  std::atomic<std::size_t> next_ = 0;
};

void write_trunks(const Trunks& trunks, const TreeLayout& layout, pipeline::VesselTree& tree) {
  for (std::size_t b = 0; b < 3; ++b) {
    const pipeline::VesselBranch branch = coronary_branches[b];
    const GrownTrunk& grown = trunks.grown[b];
    write_node(tree, layout.roots[b], pipeline::no_parent, {grown.root, grown.root_um},
               morphometry(branch).highest_order, branch);
    for (std::size_t i = 0; i < layout.branches[b].size(); ++i)
      if (trunks.plans[b].elements[i].is_trunk())
        write_trunk(trunks.plans[b], grown, layout.branches[b], i, branch, tree);
  }
}

// Away from the large vessels, which keep still, and from each other.
void space_twigs(pipeline::VesselTree& tree, std::size_t threads,
                 const std::function<void(double)>& progress) {
  std::vector<bool> still(tree.nodes());
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    still[i] = tree.orders[i] >= lowest_trunk_order;
  relax(tree, still, {.rounds = 8, .unbending_rounds = 5, .threads = threads, .farthest_radii = 30},
        held_in_place, progress);
}

} // namespace

hal::Result<CoronaryTree> generate_coronary_tree(const CoronaryTreeRequest& request,
                                                 const std::function<void(double)>& progress) {
  if (request.segments < fewest_coronary_segments || request.segments > most_coronary_segments)
    return hal::fail(hal::ErrorCode::invalid_argument, "{} segments asked for, expected {} to {}",
                     request.segments, fewest_coronary_segments, most_coronary_segments);
  constexpr std::size_t most_threads = 256;
  if (request.threads < 1 || request.threads > most_threads)
    return hal::fail(hal::ErrorCode::invalid_argument, "{} threads, expected 1 to {}",
                     request.threads, most_threads);
  const Trunks trunks = grow_trunks(request.seed, request.threads);
  const TreeLayout layout =
      lay_out(trunks.plans, request.segments, key_of(request.seed, Purpose::layout));
  CoronaryTree result;
  result.low = layout.low;
  result.lowest_order = layout.lowest_trunk_order > lowest_trunk_order ? layout.lowest_trunk_order
                                                                       : layout.low.lowest_order;
  resize(result.tree, layout.nodes);
  write_trunks(trunks, layout, result.tree);
  TwigWork work{trunks, layout, request.seed, result.tree};
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < request.threads; ++i)
    threads.emplace_back([&work] { work.work({}); });
  constexpr double growing = 0.4; // of the time
  if (progress)
    work.work([&](double done) { progress(growing * done); });
  else
    work.work({});
  for (std::thread& thread : threads)
    thread.join();
  space_twigs(result.tree, request.threads, [&](double done) {
    if (progress)
      progress(growing + (1 - growing) * done);
  });
  if (progress)
    progress(1);
  return result;
}

} // namespace octascope::sim
