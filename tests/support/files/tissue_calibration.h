// The calibration file of the spectrometer that the measurements in sd-oct-tissue were made with.
#pragma once

#include <filesystem>

#include <fmt/format.h>

#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/test_data.h"

namespace octascope::tests {

// Its curves are those of the test data, wherever these lie. The spacings are plausible for the
// instrument; its source states none. The file is gone with the object.
class TissueCalibration {
public:
  TissueCalibration() {
    const auto data = std::filesystem::absolute(test_data_folder()) / "sd-oct-tissue";
    file_ = folder_.write("sd-oct-tissue.toml",
                          fmt::format("[spectrometer]\nsamples = 1024\n"
                                      "[k_linear]\ntable = '{}'\ntable_gives = \"pixel\"\n"
                                      "[dispersion]\ntable = '{}'\n"
                                      "[background]\nmode = \"mean\"\n"
                                      "[depth]\nspacing_um = 3.5\na_spacing_um = 10.0\n"
                                      "b_spacing_um = 10.0\n",
                                      (data / "k_linear.txt").string(),
                                      (data / "dispersion_rad.txt").string()));
  }

  const std::filesystem::path& file() const { return file_; }

private:
  ScratchFolder folder_;
  std::filesystem::path file_;
};

} // namespace octascope::tests
