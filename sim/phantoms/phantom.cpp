#include "sim/phantoms/phantom.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sim/phantoms/phantom_anterior_eye.h"
#include "sim/phantoms/phantom_bench.h"
#include "sim/phantoms/phantom_cap.h"
#include "sim/phantoms/phantom_nail_fold.h"
#include "sim/phantoms/phantom_perfused.h"

namespace octascope::sim {

hal::Result<std::unique_ptr<Phantom>> make_phantom(std::string_view name, std::uint64_t seed) {
  if (name == phantom_names[0])
    return std::make_unique<AnteriorEye>(seed);
  if (name == phantom_names[1])
    return std::make_unique<NailFold>(seed);
  if (name == phantom_names[2])
    return std::make_unique<PlasticCap>(seed);
  if (name == phantom_names[3])
    return std::make_unique<PerfusedTissue>(seed);
  for (std::size_t i = 0; i < bench_phantom_names.size(); ++i)
    if (name == bench_phantom_names[i])
      return std::make_unique<BenchPhantom>(static_cast<BenchSubject>(i));
  return hal::fail(hal::ErrorCode::invalid_argument,
                   "phantom: there is none named \"{}\", expected one of {}, {}", name,
                   fmt::join(phantom_names, ", "), fmt::join(bench_phantom_names, ", "));
}

} // namespace octascope::sim
