#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "firmware-host/commands/numbers.h"
#include "firmware-host/commands/spectra_type.h"
#include "firmware-host/commands/volume/reconstruct.h"
#include "firmware-host/terminal/terminal.h"
#include "pipeline/angiography/b_scan_flow.h"

namespace octascope::firmware_host {

namespace {

constexpr int failed = 1;
constexpr int wrong_use = 2;

// What CLI11 fills in; shape stays text until the callback, so that its message is ours.
struct ReconstructCommandLine {
  std::string spectra;
  std::string shape;
  SpectraTypeArguments type;
  std::string calibration;
  std::string out;
  bool u8 = false;
  int repeats = 0; // 0: not given
  CLI::Option* volume = nullptr;
  std::size_t raw_volume = 0;
  std::string flow;
  std::string decorrelation;
  int b_scan = 0;
  std::string png;
};

int run(const ReconstructCommandLine& line) {
  const auto complain = [](const hal::Error& error, int status) {
    warn("octascope reconstruct: {}\n", error.message);
    return status;
  };
  ReconstructOptions options;
  options.spectra = line.spectra;
  if (!line.shape.empty()) {
    const auto shape = pipeline::SpectraShape::parse(line.shape);
    if (!shape)
      return complain(shape.error(), wrong_use);
    options.shape = *shape;
  }
  if (line.volume->count() > 0)
    options.raw_volume = line.raw_volume;
  const SpectraType type = spectra_type_of(line.type);
  options.type = type.type;
  options.significant_bits = type.significant_bits;
  options.right_shift = line.type.shift;
  options.volume = line.out;
  options.display_counts = line.u8;
  options.picture_b_scan = line.b_scan;
  if (!line.calibration.empty())
    options.calibration = line.calibration;
  if (!line.png.empty())
    options.picture = line.png;
  if (line.repeats > 0)
    options.repeats = line.repeats;
  if (!line.flow.empty())
    options.flow = line.flow;
  if (!line.decorrelation.empty())
    options.decorrelation = line.decorrelation;
  const auto done = reconstruct_volume(options);
  if (done)
    return 0;
  return complain(done.error(),
                  done.error().code == hal::ErrorCode::invalid_argument ? wrong_use : failed);
}

} // namespace

void add_reconstruct_command(CLI::App& app, int& exit_status) {
  CLI::App* command = app.add_subcommand("reconstruct", "Raw spectra to a volume of levels (NRRD)");
  auto line = std::make_shared<ReconstructCommandLine>();
  CLI::Option* spectra =
      command
          ->add_option("--spectra", line->spectra,
                       "Raw spectra, little-endian, [B-scan][A-scan][sample]; or a "
                       "recording of them (octascope capture, record --raw)")
          ->required()
          ->type_name("FILE");
  command
      ->add_option("--shape", line->shape,
                   "B-scans (all their sweeps), A-scans per B-scan and samples per line, like "
                   "100,100,1024; a recording says it itself, and of which type samples are")
      ->type_name("B,A,N");
  add_spectra_type_options(*command, line->type, spectra);
  line->volume =
      command
          ->add_option("--volume", line->raw_volume,
                       "Which volume of a recording, counted from 0 (its first whole one "
                       "if not given)")
          ->check(within(0, 1000000000))
          ->type_name("N");
  command
      ->add_option("--calibration", line->calibration,
                   "Calibration; without it a recording's own, else no resampling and no "
                   "dispersion, Hann window")
      ->type_name("FILE.toml");
  command->add_option("--out", line->out, "Volume to write: levels in dB, depth fastest")
      ->required()
      ->type_name("FILE.nrrd");
  command->add_flag("--u8", line->u8, "Write the display's 8-bit counts instead of float dB");
  CLI::Option* repeats =
      command
          ->add_option("--repeats", line->repeats,
                       "Successive sweeps of one position: their levels are averaged, and volumes "
                       "have B/M B-scans")
          ->check(within(pipeline::BScanFlow::fewest_repeats, pipeline::BScanFlow::most_repeats))
          ->type_name("M");
  command
      ->add_option("--flow", line->flow,
                   "Volume to write: what flows between repeats, 0 static to 1 flowing, NaN where "
                   "it cannot be told")
      ->needs(repeats)
      ->type_name("FILE.nrrd");
  command
      ->add_option(
          "--decorrelation", line->decorrelation,
          "Volume to write: D = 1 - |S Y1 conj(Y2) exp(-ip)| / (S (|Y1|^2 + |Y2|^2) / 2); "
          "Y1, Y2 successive repeats' complex bins; S the sum over the M - 1 pairs and 3 "
          "A-scans by 5 depths, as far as they lie in the B-scan; p the argument of the sum "
          "of Y1 conj(Y2) over all depths of an A-scan; axial and lateral motion taken off")
      ->needs(repeats)
      ->type_name("FILE.nrrd");
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
                  "    --calibration spectrometer.toml --out volume.nrrd --bscan 50 --png b50.png\n"
                  "  octascope reconstruct --spectra repeated.raw --shape 200,100,1024 \\\n"
                  "    --repeats 2 --out volume.nrrd --flow flow.nrrd\n"
                  "  octascope reconstruct --spectra eye-raw.h5 --volume 12 --u8 --out v12.nrrd");
  command->callback([line, &exit_status] { exit_status = run(*line); });
}

} // namespace octascope::firmware_host
