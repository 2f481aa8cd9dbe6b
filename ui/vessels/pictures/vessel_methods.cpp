#include "ui/vessels/pictures/vessel_methods.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "ui/gl/context_info.h"
#include "ui/vessels/hybrid/hybrid_method.h"
#include "ui/vessels/hybrid/quads_share.h"
#include "ui/vessels/quads/quads_method.h"
#include "ui/vessels/quads/streamed_quads_method.h"
#include "ui/vessels/tubes/tubes_method.h"

namespace octascope::ui {

namespace {

using Made = hal::Result<std::unique_ptr<VesselMethod>>;

template <class Kind> Made as_method(hal::Result<std::unique_ptr<Kind>> made) {
  if (!made)
    return tl::make_unexpected(made.error());
  return std::unique_ptr<VesselMethod>{std::move(*made)};
}

// Where GL is software, it would but take the splatter's time.
Made make_hybrid(std::shared_ptr<NodeTexture> nodes, const VesselMethodOptions& options) {
  HybridMethod::Share share;
  if (!gl::describe_context().software) {
    HAL_TRY(auto quads, QuadsShare::create(std::move(nodes)));
    share.gl = std::move(quads);
  }
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  HAL_TRY(auto hybrid, HybridMethod::create(cores - 1, options.threads, std::move(share)));
  return std::make_unique<HybridMethod>(std::move(hybrid));
}

} // namespace

std::string_view to_string(VesselMethodKind kind) {
  switch (kind) {
  case VesselMethodKind::tubes_gpu: return "tubes-gpu";
  case VesselMethodKind::tubes_cpu: return "tubes-cpu";
  case VesselMethodKind::quads_gpu: return "quads-gpu";
  case VesselMethodKind::quads_cpu: return "quads-cpu";
  case VesselMethodKind::balanced: return "balanced";
  case VesselMethodKind::hybrid: return "hybrid";
  }
  return "hybrid";
}

std::optional<VesselMethodKind> vessel_method_named(std::string_view name) {
  for (const VesselMethodKind kind : all_vessel_methods)
    if (to_string(kind) == name)
      return kind;
  return std::nullopt;
}

Made make_vessel_method(VesselMethodKind kind, std::shared_ptr<NodeTexture> nodes,
                        const VesselMethodOptions& options) {
  switch (kind) {
  case VesselMethodKind::tubes_gpu:
    return as_method(TubesMethod::create(std::move(nodes), options.choice, options.tubes));
  case VesselMethodKind::tubes_cpu:
    return as_method(StreamedTubesMethod::create(options.choice, options.threads, options.tubes));
  case VesselMethodKind::quads_gpu:
    return as_method(QuadsMethod::create(std::move(nodes), options.choice));
  case VesselMethodKind::quads_cpu:
    return as_method(StreamedQuadsMethod::create(nullptr, options.choice, options.threads));
  case VesselMethodKind::balanced:
    return as_method(
        StreamedQuadsMethod::create(std::move(nodes), options.choice, options.threads));
  case VesselMethodKind::hybrid: break;
  }
  return make_hybrid(std::move(nodes), options);
}

} // namespace octascope::ui
