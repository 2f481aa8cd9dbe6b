// The ways of drawing a vessel tree, by name.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "hal/result.h"
#include "pipeline/threads/worker_pool.h"
#include "ui/vessels/scene/cluster_culling.h"
#include "ui/vessels/scene/node_texture.h"
#include "ui/vessels/scene/vessel_method.h"
#include "ui/vessels/tubes/tube_shape.h"

namespace octascope::ui {

enum class VesselMethodKind : std::uint8_t {
  tubes_gpu, // triangles around each vessel, expanded by GL
  tubes_cpu, // by the processor
  quads_gpu, // quads that face the eye, expanded by GL
  quads_cpu, // by the processor
  balanced,  // by both, whichever is free
  hybrid,    // level of detail; the thinnest splatted by the processor
};
inline constexpr std::array all_vessel_methods{
    VesselMethodKind::tubes_gpu, VesselMethodKind::tubes_cpu, VesselMethodKind::quads_gpu,
    VesselMethodKind::quads_cpu, VesselMethodKind::balanced,  VesselMethodKind::hybrid};

// As on the command line: "quads-gpu".
std::string_view to_string(VesselMethodKind kind);
std::optional<VesselMethodKind> vessel_method_named(std::string_view name);

struct VesselMethodOptions {
  ClusterChoice choice = ClusterChoice::visible; // `all` also draws what cannot be seen
  TubeShape tubes;
  pipeline::ThreadSetup threads; // called on each thread that a method starts
};

// `nodes` may be shared by methods that draw the same tree in the same context: it takes as much
// memory as the tree. ErrorCode::unsupported: this GL cannot compile the shaders, or, for hybrid,
// the splatter does not support this processor's vector unit.
hal::Result<std::unique_ptr<VesselMethod>>
make_vessel_method(VesselMethodKind kind, std::shared_ptr<NodeTexture> nodes,
                   const VesselMethodOptions& options = {});

} // namespace octascope::ui
