#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "firmware-host/commands/numbers.h"
#include "firmware-host/commands/volume/reconstruct.h"
#include "firmware-host/terminal/terminal.h"

namespace octascope::firmware_host {

namespace {

constexpr int failed = 1;
constexpr int wrong_use = 2;

// What CLI11 fills in; shape stays text until the callback, so that its message is ours.
struct ReconstructCommandLine {
  std::string spectra;
  std::string shape;
  std::string type = "u16";
  int shift = 0;
  std::string calibration;
  std::string out;
  bool u8 = false;
  int b_scan = 0;
  std::string png;
};

// What --dtype says: cameras of 10, 12 and 14 bits are u16 with fewer significant ones. u16 and u8
// leave open how many there are: what the shift leaves.
using TypeAndBits = std::pair<hal::SampleType, std::optional<int>>;
const std::map<std::string, TypeAndBits>& types() {
  using hal::SampleType;
  static const std::map<std::string, TypeAndBits> all{
      {"u8", {SampleType::u8, {}}},   {"u10", {SampleType::u16, 10}},
      {"u12", {SampleType::u16, 12}}, {"u14", {SampleType::u16, 14}},
      {"u16", {SampleType::u16, {}}}, {"f32", {SampleType::f32, {}}}};
  return all;
}

int run(const ReconstructCommandLine& line) {
  const auto complain = [](const hal::Error& error, int status) {
    warn("octascope reconstruct: {}\n", error.message);
    return status;
  };
  const auto shape = pipeline::SpectraShape::parse(line.shape);
  if (!shape)
    return complain(shape.error(), wrong_use);
  ReconstructOptions options;
  options.spectra = line.spectra;
  options.shape = *shape;
  std::tie(options.type, options.significant_bits) = types().at(line.type);
  options.right_shift = line.shift;
  options.volume = line.out;
  options.display_counts = line.u8;
  options.picture_b_scan = line.b_scan;
  if (!line.calibration.empty())
    options.calibration = line.calibration;
  if (!line.png.empty())
    options.picture = line.png;
  if (line.b_scan < 0 || line.b_scan >= shape->b_scans)
    return complain(
        {hal::ErrorCode::invalid_argument,
         fmt::format("--bscan is {}, expected 0 to {}", line.b_scan, shape->b_scans - 1)},
        wrong_use);
  const auto done = reconstruct_volume(options);
  return done ? 0 : complain(done.error(), failed);
}

} // namespace

void add_reconstruct_command(CLI::App& app, int& exit_status) {
  CLI::App* command = app.add_subcommand("reconstruct", "Raw spectra to a volume of levels (NRRD)");
  auto line = std::make_shared<ReconstructCommandLine>();
  command
      ->add_option("--spectra", line->spectra,
                   "Raw spectra, little-endian, [B-scan][A-scan][sample]")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--shape", line->shape,
                   "B-scans, A-scans per B-scan and samples per line, like 100,100,1024")
      ->required()
      ->type_name("B,A,N");
  command
      ->add_option("--dtype", line->type,
                   "Type of a sample (u16 if not given); u10, u12 and u14 take 16 bits")
      ->check(CLI::IsMember({"u8", "u10", "u12", "u14", "u16", "f32"}))
      ->type_name("u8|u10|u12|u14|u16|f32")
      ->option_text("u8|u10|u12|u14|u16|f32");
  command
      ->add_option("--shift", line->shift,
                   "Bits to shift each sample to the right: left-justified 12-bit counts need "
                   "--dtype u12 --shift 4")
      ->check(within(0, 15))
      ->type_name("BITS");
  command
      ->add_option("--calibration", line->calibration,
                   "Calibration; without it no resampling and no dispersion, Hann window")
      ->type_name("FILE.toml");
  command->add_option("--out", line->out, "Volume to write: levels in dB, depth fastest")
      ->required()
      ->type_name("FILE.nrrd");
  command->add_flag("--u8", line->u8, "Write the display's 8-bit counts instead of float dB");
  CLI::Option* b_scan = command->add_option("--bscan", line->b_scan, "B-scan to draw, from 0")
                            ->check(within(0, 65535))
                            ->type_name("I");
  CLI::Option* png = command
                         ->add_option("--png", line->png,
                                      "Picture of that B-scan: rows are depths, columns A-scans")
                         ->type_name("FILE.png");
  b_scan->needs(png);
  png->needs(b_scan);
  command->footer("Example:\n"
                  "  octascope reconstruct --spectra spectra.raw --shape 100,100,1024 \\\n"
                  "    --calibration spectrometer.toml --out volume.nrrd --bscan 50 --png b50.png");
  command->callback([line, &exit_status] { exit_status = run(*line); });
}

} // namespace octascope::firmware_host
