// Whatever is in a script of faults or of controls, it is read or refused with the file's name. New
// random scripts in every run; the sanitizers watch.
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "sim/devices/control_script.h"
#include "sim/faults/fault_script.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/program/built_places.h"

namespace octascope::sim {
namespace {

std::string shipped(const std::string& name) {
  return tests::whole_file(tests::source_folder() / "sim" / name);
}

template <class Script> void try_all(const std::string& good) {
  ASSERT_FALSE(good.empty());
  ASSERT_TRUE(Script::parse(good, "script.toml"));
  std::mt19937_64 generator{tests::fresh_seed()};
  int refused = 0;
  for (int round = 0; round < 1500; ++round) {
    const auto script = Script::parse(tests::mutate(good, generator), "script.toml");
    if (script)
      continue;
    ++refused;
    ASSERT_NE(script.error().message.find("script.toml"), std::string::npos)
        << "round " << round << ": " << script.error().message;
  }
  EXPECT_GT(refused, 100); // else nothing was tried
}

TEST(MutatedScripts, of_faults) {
  try_all<FaultScript>(shipped("faults/examples/everything.toml"));
}

TEST(MutatedScripts, of_controls) {
  try_all<ControlScript>(shipped("controls/tour.toml"));
}

} // namespace
} // namespace octascope::sim
