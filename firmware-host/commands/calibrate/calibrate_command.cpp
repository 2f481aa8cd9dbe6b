#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "firmware-host/commands/calibrate/calibrate.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/terminal/terminal.h"
#include "hal/number_text.h"

namespace octascope::firmware_host {

namespace {

struct CalibrateCommandLine {
  CalibrateOptions options;
  std::string lines;
  std::string shape;
  bool json = false;
};

// "nm,nm,…"
hal::Result<std::vector<double>> parse_lines(std::string_view text) {
  std::vector<double> lines;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const auto value = hal::number_of<double>(rest.substr(0, comma));
    if (!value || comma + 1 == rest.size())
      return hal::fail(hal::ErrorCode::invalid_argument,
                       "--lines is \"{}\", expected wavelengths in nm, as in 810.37,826.45,840.82",
                       text);
    lines.push_back(*value);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return lines;
}

// CLI11's transformer takes the values themselves, too, as numbers: names are asked for before it.
template <class Value> std::vector<std::string> names_of(const std::map<std::string, Value>& map) {
  std::vector<std::string> names;
  for (const auto& [name, value] : map)
    names.push_back(name);
  return names;
}

int run(CalibrateCommandLine& line) {
  const auto complain = [](const hal::Error& error, int status = exit_wrong_use) {
    warn("octascope calibrate: {}\n", error.message);
    return status;
  };
  const auto lines = parse_lines(line.lines);
  if (!lines)
    return complain(lines.error());
  line.options.lines_nm = *lines;
  if (!line.shape.empty()) {
    const auto shape = pipeline::SpectraShape::parse(line.shape);
    if (!shape)
      return complain(shape.error());
    line.options.tissue_shape = *shape;
  }
  if (const auto checked = check(line.options); !checked)
    return complain(checked.error());
  const auto verdict = calibrate(line.options);
  if (!verdict)
    return complain(verdict.error(), exit_failed);
  if (line.json)
    say("{}\n", to_json(*verdict));
  else
    say("{}", to_text(*verdict));
  return exit_done;
}

void add_mirror_options(CLI::App& command, CalibrateOptions& options) {
  command
      .add_option(
          "--mirror", options.mirrors,
          "Spectrum of a mirror; twice, at unequal depths (any order). Raw samples, a recording "
          "of them (octascope capture), or a .txt or .csv with one number a line, as for all "
          "spectra here")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      .add_option("--dark", options.darks.plain,
                  "Spectrum to subtract from both mirrors; several are averaged")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command.add_option("--dark-none", options.darks.none, "Spectrum without any light")
      ->type_name("FILE");
  command
      .add_option("--dark-reference", options.darks.reference,
                  "Spectrum of the reference arm alone")
      ->type_name("FILE");
  command
      .add_option("--dark-sample", options.darks.sample,
                  "Spectrum of the sample arm alone; once, or once for each mirror")
      ->type_name("FILE")
      ->allow_extra_args(false);
  const std::map<std::string, pipeline::SampleSide> sides{
      {"both", pipeline::SampleSide::both_mirrors},
      {"first", pipeline::SampleSide::first_mirror},
      {"second", pipeline::SampleSide::second_mirror},
      {"none", pipeline::SampleSide::no_mirror}};
  command
      .add_option("--sample-side", options.side,
                  "Which mirrors lie on the side of zero delay where samples lie (both if not "
                  "given, or what makes the tissue sharpest)")
      ->transform(CLI::CheckedTransformer(sides))
      ->transform(CLI::IsMember(names_of(sides)))
      ->type_name("both|first|second|none")
      ->option_text("both|first|second|none");
  command
      .add_option("--distance-um", options.mirror_distance_um,
                  "Distance between the two mirrors: gives the depth spacing")
      ->check(within(1e-3, 1e9))
      ->type_name("UM");
}

void add_other_options(CLI::App& command, CalibrateCommandLine& line) {
  CalibrateOptions& options = line.options;
  auto* lamp = command.add_option("--lamp", options.lamp, "Spectrum of an emission-line lamp")
                   ->type_name("FILE");
  auto* lines = command.add_option("--lines", line.lines, "Its lines, in the order of the pixels")
                    ->type_name("NM,NM,...");
  lamp->needs(lines);
  lines->needs(lamp);
  auto* tissue =
      command
          .add_option("--tissue", options.tissue,
                      "Raw spectra of tissue: with mirrors they tell the sample's side, else the "
                      "dispersion is found from their sharpness")
          ->type_name("FILE");
  command
      .add_option("--shape", line.shape,
                  "Of the tissue: B-scans, A-scans, samples; a recording says it itself")
      ->needs(tissue)
      ->type_name("B,A,N");
  command.add_option("--calibration", options.base, "Calibration whose k curve the tissue uses")
      ->type_name("FILE.toml");
  command
      .add_option("--samples", options.samples,
                  "Samples of a line, when a file has several (they are averaged)")
      ->check(within(pipeline::fewest_samples, pipeline::most_samples))
      ->type_name("N");
  const std::map<std::string, hal::SampleType> types{
      {"u8", hal::SampleType::u8}, {"u16", hal::SampleType::u16}, {"f32", hal::SampleType::f32}};
  command
      .add_option("--dtype", options.type,
                  "Type of a sample (as the file's name says, like x_f32.raw, else u16)")
      ->transform(CLI::CheckedTransformer(types))
      ->transform(CLI::IsMember(names_of(types)))
      ->type_name("u8|u16|f32")
      ->option_text("u8|u16|f32");
  command.add_option("--tissue-dtype", options.tissue_type, "Likewise, of the tissue")
      ->transform(CLI::CheckedTransformer(types))
      ->transform(CLI::IsMember(names_of(types)))
      ->type_name("u8|u16|f32")
      ->option_text("u8|u16|f32");
  command
      .add_option("--bits", options.significant_bits,
                  "Bits of a sample: tells what is saturated (all of its type if not given)")
      ->check(within(1, 16))
      ->type_name("BITS");
  command.add_option("--spacing-um", options.spacing_um, "Depth spacing of a bin, when known")
      ->check(within(1e-3, 1e6))
      ->type_name("UM");
  command
      .add_option(
          "--refractive-index", options.refractive_index,
          "Of the medium in which depths are to be told, 1.38 for tissue: the spacing found "
          "from --distance-um is divided by it (1, air, if not given), --spacing-um holds "
          "in it")
      ->check(within(pipeline::least_refractive_index, pipeline::most_refractive_index))
      ->type_name("N");
  command
      .add_option(
          "--camera", options.camera,
          "Which camera the spectra are of, as octascope devices tells it: with another one "
          "the display will say so")
      ->type_name("TEXT");
  command.add_option("--out", options.out, "Calibration to write; its curves go beside it")
      ->required()
      ->type_name("FILE.toml");
  command.add_option("--picture", options.picture, "Picture of the verdict")->type_name("FILE.png");
  command.add_flag("--json", line.json, "The verdict as one JSON object");
}

} // namespace

void add_calibrate_command(CLI::App& app, int& exit_status) {
  CLI::App* command = app.add_subcommand(
      "calibrate", "Measurements of a spectrometer to a calibration, with a verdict on it");
  auto line = std::make_shared<CalibrateCommandLine>();
  add_mirror_options(*command, line->options);
  add_other_options(*command, *line);
  command->footer(
      "Examples:\n"
      "  octascope calibrate --mirror near.raw --mirror far.raw --dark dark.raw \\\n"
      "    --distance-um 500 --out spectrometer.toml --picture verdict.png\n"
      "  octascope calibrate --mirror near.h5 --mirror far.h5 --dark dark.h5 --out s.toml\n"
      "  octascope calibrate --lamp argon.raw --lines 810.37,826.45,840.82,852.14 \\\n"
      "    --tissue finger.raw --shape 100,100,1024 --out spectrometer.toml");
  command->callback([line, &exit_status] { exit_status = run(*line); });
}

} // namespace octascope::firmware_host
