// Whatever is wrong with what a user gives: one clear line, the right exit status, at once, and
// nothing written.
#include <algorithm>
#include <array>
#include <filesystem>
#include <ostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

struct BadInput {
  std::string name;
  std::string arguments; // "@x" is the file x of the folder
  int exit_status;
  std::vector<std::string> told; // what the message says: place, found, expected
  friend void PrintTo(const BadInput& input, std::ostream* out) { *out << input.name; }
};

// Good and broken files to name on the command line; spectra are 4 × 8 × 32.
void lay_out_files(const ScratchFolder& folder) {
  const std::vector<std::uint16_t> counts(4 * 8 * 32, 1000);
  folder.write_values<std::uint16_t>("spectra.raw", counts);
  folder.write_values<std::uint16_t>("deep.raw", std::vector<std::uint16_t>(4 * 8 * 32, 2000));
  folder.write("empty", "");
  std::filesystem::create_directory(folder / "folder");
  std::string rising;
  std::string with_nan;
  std::string falling;
  for (int i = 0; i < 32; ++i) {
    rising += std::to_string(i) + "\n";
    with_nan += (i == 7 ? "nan" : std::to_string(i)) + "\n";
    falling += std::to_string(i == 20 ? 3 : i) + "\n";
  }
  folder.write("rising.txt", rising);
  folder.write("with_nan.txt", with_nan);
  folder.write("falling.txt", falling);
  const auto calibration = [&](std::string_view name, std::string_view curve,
                               std::string_view more) {
    folder.write(name, "[spectrometer]\nsamples = 32\n[k_linear]\ntable = \"" + std::string{curve} +
                           "\"\n" + std::string{more});
  };
  calibration("good.toml", "rising.txt", "");
  calibration("nan.toml", "with_nan.txt", "");
  calibration("falling.toml", "falling.txt", "");
  calibration("no_curve.toml", "nowhere.txt", "");
  calibration("unknown_key.toml", "rising.txt", "[depth]\nspacing_mm = 3.5\n");
  folder.write("configuration.toml", "[display]\nwidht = 640\n");
  folder.write("syntax.toml", "[display\n");
  folder.write("range.toml", "[scan]\nline_rate_hz = -5\n");
  folder.write("faults.toml", "[[fault]]\ndevice = \"line_camera\"\nkind = \"unplug\"\nat_s = 1\n"
                              "duration_s = 1\nhow_bad = 3\n");
  folder.write("strip.toml", "[[transfer]]\nname = \"mine\"\nkind = \"table\"\n"
                             "file = \"nowhere.png\"\n");
  folder.write("controls.toml", "[[event]]\ntime_s = 1\nswitch = 7\nvalue = 1\n");
}

BadInput bad(std::string name, std::string arguments, int exit_status,
             std::vector<std::string> told) {
  return {std::move(name), std::move(arguments), exit_status, std::move(told)};
}

std::vector<BadInput> bad_inputs() {
  const std::string shaped = "run --spectra @spectra.raw --shape ";
  const std::string play = shaped + "4,8,32 ";
  const std::string reconstruct = "reconstruct --spectra @spectra.raw --shape 4,8,32 ";
  const std::string draw = "render --phantom cap --out @r.png ";
  return {
      bad("missing_spectra", "run --spectra @nowhere.raw --shape 4,8,32", 1,
          {"nowhere.raw", "No such file", "2048 bytes"}),
      bad("wrong_size_for_the_shape", shaped + "5,8,32", 1,
          {"spectra.raw", "found 2048 bytes", "expected 2560"}),
      bad("spectra_are_a_directory", "run --spectra @folder --shape 4,8,32", 2,
          {"folder", "is a directory", "expected"}),
      bad("spectra_are_empty", "run --spectra @empty --shape 4,8,32", 1,
          {"empty", "found 0 bytes", "expected 2048"}),
      bad("zero_shape", shaped + "0,8,32", 2, {"shape", "is 0", "expected 1 to"}),
      bad("negative_shape", shaped + "4,-8,32", 2, {"shape", "-8", "expected 1 to"}),
      bad("garbage_shape", shaped + "many", 2, {"shape", "\"many\"", "expected B,A,N"}),
      bad("huge_shape", shaped + "99999999999,8,32", 2, {"shape", "99999999999", "expected"}),
      bad("shape_without_spectra", "run --shape 4,8,32", 2, {"--shape", "--spectra"}),
      bad("spectra_without_shape", "run --spectra @spectra.raw", 2, {"--spectra", "--shape B,A,N"}),
      bad("missing_calibration", play + "--calibration @nowhere.toml", 1,
          {"nowhere.toml", "No such file"}),
      bad("missing_calibration_of_a_phantom", "run --sim --calibration @nowhere.toml", 1,
          {"nowhere.toml", "No such file"}),
      bad("calibration_is_a_directory", play + "--calibration @folder", 2,
          {"folder", "is a directory", "expected a TOML file"}),
      bad("calibration_is_empty", play + "--calibration @empty", 2, {"empty", "expected"}),
      bad("missing_curve", play + "--calibration @no_curve.toml", 1,
          {"nowhere.txt", "no such file", "expected a text file of 32 numbers"}),
      bad("curve_with_nan", play + "--calibration @nan.toml", 1,
          {"with_nan.txt:8", "nan", "expected"}),
      bad("curve_not_monotone", play + "--calibration @falling.toml", 1,
          {"falling.txt", "expected"}),
      bad("calibration_with_unknown_key", play + "--calibration @unknown_key.toml", 2,
          {"unknown_key.toml:6", "unknown key \"spacing_mm\"", "spacing_um"}),
      bad("missing_configuration", "run --config @nowhere.toml", 1,
          {"nowhere.toml", "No such file"}),
      bad("configuration_with_unknown_key", "run --config @configuration.toml", 2,
          {"configuration.toml:2", "unknown key \"widht\"", "width"}),
      bad("configuration_that_is_no_toml", "run --config @syntax.toml", 1,
          {"syntax.toml:1", "not TOML"}),
      bad("configuration_out_of_range", "run --config @range.toml", 2,
          {"range.toml:2", "line_rate_hz is -5", "expected a number from 1"}),
      bad("missing_fault_script", "run --sim --faults @nowhere.toml", 1,
          {"nowhere.toml", "No such file"}),
      bad("fault_script_with_unknown_key", "run --sim --faults @faults.toml", 2,
          {"faults.toml:6", "unknown key \"how_bad\""}),
      bad("control_script_out_of_range", "run --sim --controls @controls.toml", 2,
          {"controls.toml:3", "switch is 7", "expected"}),
      bad("unknown_phantom", "run --sim --phantom teapot", 2, {"teapot", "anterior_eye"}),
      bad("unknown_option", "run --sim --teapot", 2, {"--teapot"}),
      bad("unknown_command", "boil", 2, {"octascope"}),
      bad("no_command", "", 2, {"subcommand"}),
      bad("unknown_display", "run --display paper", 2, {"--display", "paper", "offscreen"}),
      bad("garbage_size", "run --size wide", 2, {"--size", "\"wide\"", "1280x720"}),
      bad("zero_size", "run --size 0x360", 2, {"--size", "\"0x360\"", "1 to 16384"}),
      bad("zero_duration", "run --duration 0", 2, {"--duration", "0"}),
      bad("zero_volumes", "run --volumes 0", 2, {"--volumes", "0"}),
      bad("duration_and_volumes", "run --duration 1 --volumes 1", 2, {"--duration", "--volumes"}),
      bad("snapshot_into_no_folder", "run --sim --snapshot @nowhere/s.png", 1,
          {"nowhere/s.png", "No such file"}),
      bad("report_into_no_folder", "run --sim --report @nowhere/r.json", 1,
          {"nowhere/r.json", "No such file"}),
      bad("report_is_a_directory", "run --sim --report @folder", 2,
          {"folder", "is a directory", "expected the name of a file"}),
      bad("snapshot_and_report_in_one_file", "run --sim --snapshot @one --report @one", 2,
          {"--snapshot", "--report", "two files"}),
      bad("reconstruct_a_missing_file",
          "reconstruct --spectra @nowhere.raw --shape 4,8,32 --out @v.nrrd", 1,
          {"nowhere.raw", "No such file"}),
      bad("reconstruct_zero_shape",
          "reconstruct --spectra @spectra.raw --shape 4,0,32 --out @v.nrrd", 2,
          {"shape", "is 0", "expected 1 to"}),
      bad("reconstruct_into_no_folder", reconstruct + "--out @nowhere/v.nrrd", 1,
          {"nowhere/v.nrrd", "No such file"}),
      bad("reconstruct_with_a_broken_curve", reconstruct + "--calibration @nan.toml --out @v.nrrd",
          1, {"with_nan.txt:8", "nan"}),
      bad("reconstruct_flow_without_repeats", reconstruct + "--out @v.nrrd --flow @f.nrrd", 2,
          {"--flow", "--repeats"}),
      bad("reconstruct_decorrelation_without_repeats",
          reconstruct + "--out @v.nrrd --decorrelation @d.nrrd", 2,
          {"--decorrelation", "--repeats"}),
      bad("reconstruct_one_repeat", reconstruct + "--out @v.nrrd --repeats 1", 2,
          {"--repeats", "\"1\"", "from 2 to 4"}),
      bad("reconstruct_five_repeats", reconstruct + "--out @v.nrrd --repeats 5", 2,
          {"--repeats", "\"5\"", "from 2 to 4"}),
      bad("reconstruct_part_of_the_repeats", reconstruct + "--out @v.nrrd --repeats 3", 2,
          {"4 sweeps", "multiple of the 3 repeats"}),
      bad("reconstruct_no_such_b_scan_of_repeats",
          reconstruct + "--out @v.nrrd --repeats 2 --bscan 2 --png @b.png", 2,
          {"--bscan is 2", "0 to 1"}),
      bad("reconstruct_two_volumes_in_one_file",
          reconstruct + "--out @v.nrrd --repeats 2 --flow @v.nrrd", 2, {"--flow", "--out"}),
      bad("reconstruct_no_such_b_scan", reconstruct + "--out @v.nrrd --bscan 4 --png @b.png", 2,
          {"--bscan is 4", "expected 0 to 3"}),
      bad("render_of_nothing", "render --out @r.png", 2,
          {"found 0 volumes", "expected one", "--volume"}),
      bad("render_of_two_volumes", "render --volume @v.nrrd --phantom cap --out @r.png", 2,
          {"found 2 volumes", "expected one"}),
      bad("render_to_an_option", "render --phantom cap --out --help", 2,
          {"--out", "\"--help\"", "looks like an option", "./--help"}),
      bad("run_with_an_option_for_a_report", "run --report --sim", 2,
          {"--report", "\"--sim\"", "looks like an option"}),
      bad("render_to_nowhere", "render --phantom cap", 2, {"--out", "required"}),
      bad("render_of_a_missing_volume", "render --volume @nowhere.nrrd --out @r.png", 1,
          {"nowhere.nrrd", "no such file"}),
      bad("render_one_of_a_missing_volume", "render --volume @nowhere.h5 --at 0 --out @r.png", 1,
          {"nowhere.h5", "no such file", "a NRRD volume or a recording"}),
      bad("render_of_a_folder", "render --volume @folder --at 0 --out @r.png", 2,
          {"folder", "is a directory", "a NRRD volume or a recording"}),
      bad("render_of_what_is_no_volume", "render --volume @spectra.raw --out @r.png", 1,
          {"spectra.raw", "expected a NRRD volume or a recording"}),
      bad("render_one_of_what_is_no_volume", "render --volume @spectra.raw --at 1 --out @r.png", 1,
          {"spectra.raw", "expected a NRRD volume or a recording"}),
      bad("render_with_missing_vessels", draw + "--vessels @nowhere.swc", 1,
          {"nowhere.swc", "No such file"}),
      bad("render_with_a_missing_registration",
          draw + "--vessels @nowhere.swc --registration @nowhere.toml", 1,
          {"nowhere.toml", "No such file"}),
      bad("render_of_missing_spectra",
          "render --spectra @nowhere.raw --shape 4,8,32 --calibration @nowhere.toml --out @r.png",
          1, {"nowhere.raw", "No such file"}),
      bad("render_with_a_missing_calibration",
          "render --spectra @spectra.raw --shape 4,8,32 --calibration @nowhere.toml --out @r.png",
          1, {"nowhere.toml", "No such file"}),
      bad("render_with_a_missing_strip", draw + "--config @strip.toml", 2,
          {"nowhere.png", "No such file"}),
      bad("render_missing_vessels_alone", "vessels render @nowhere.swc --out @r.png", 1,
          {"nowhere.swc", "No such file"}),
      bad("run_of_floats", play + "--dtype f32", 2,
          {"--dtype is f32", "u8, u10, u12, u14 or u16", "octascope reconstruct"}),
      bad("render_of_floats",
          "render --spectra @spectra.raw --shape 4,8,32 --dtype f32 --out @r.png", 2,
          {"--dtype is f32", "octascope reconstruct"}),
      bad("run_of_more_bits_than_said", "run --spectra @deep.raw --shape 4,8,32 --dtype u10", 1,
          {"deep.raw: B-scan 0, A-scan 0, sample 0 is 2000", "at most 1023", "another --dtype"}),
      bad("run_of_a_type_without_spectra", "run --sim --dtype u8", 2, {"--dtype", "--spectra"}),
      bad("render_of_spectra_without_shape", "render --spectra @spectra.raw --out @r.png", 2,
          {"--spectra", "--shape"}),
      bad("render_into_no_folder", "render --phantom cap --out @nowhere/r.png", 1,
          {"nowhere/r.png", "No such file"}),
      bad("render_into_a_folder", "render --phantom cap --out @folder", 2,
          {"folder", "is a directory", "expected the name of a file"}),
      bad("render_with_an_unknown_technique", draw + "--technique oils", 2, {"oils", "shaded"}),
      bad("render_of_an_unknown_phantom", "render --phantom teapot --out @r.png", 2,
          {"teapot", "anterior_eye"}),
      bad("render_with_an_unknown_transfer_function", draw + "--transfer oils", 2,
          {"--transfer is \"oils\"", "window, smooth"}),
      bad("render_with_an_unknown_colour_map", draw + "--colours oils", 2,
          {"--colours is \"oils\"", "grey, amber"}),
      bad("render_with_a_garbage_window", draw + "--window 8", 2,
          {"--window is \"8\"", "expected L,S", "8,36"}),
      bad("render_with_a_window_of_nothing", draw + "--window 8,0", 2, {"\"8,0\"", "1 to 128"}),
      bad("render_cut_at_half_a_corner", draw + "--cut 44,", 2, {"\"44,\"", "44 or 44,150"}),
      bad("render_cut_twice", draw + "--cut 44 --cut 45", 2, {"--cut"}),
      bad("render_cut_before_the_volume", draw + "--cut -1", 2, {"\"-1\"", "counted from 0"}),
      bad("render_cut_behind_the_volume", draw + "--cut 9999", 2, {"9999", "0 to 79"}),
      bad("render_cut_beside_the_volume", draw + "--cut 44,9999", 2, {"9999", "0 to 299"}),
      bad("render_with_a_garbage_size", draw + "--size big", 2, {"--size", "\"big\"", "1280x720"}),
      bad("render_over_the_top", draw + "--tilt 95", 2, {"--tilt", "95", "-89 to 89"}),
      bad("render_from_no_direction", draw + "--yaw nan", 2, {"--yaw", "nan", "-180 to 180"}),
      bad("render_from_within", draw + "--distance 0", 2, {"--distance", "0", "0.6 to 8"}),
      bad("render_without_steps", draw + "--steps 0", 2, {"--steps", "0"}),
      bad("render_a_surface_by_the_processor", draw + "--technique surface --drawn-by processor", 2,
          {"--drawn-by is processor", "surface", "rays, shaded or maximum"}),
      bad("render_with_a_broken_configuration", draw + "--config @configuration.toml", 2,
          {"configuration.toml:2", "unknown key \"widht\""}),
  };
}

class BadInputs : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputs, are_refused_in_one_line_at_once_and_nothing_is_written) {
  const ScratchFolder folder;
  lay_out_files(folder);
  std::vector<std::string> arguments;
  std::istringstream words{GetParam().arguments};
  for (std::string word; words >> word;)
    arguments.push_back(word.starts_with('@') ? (folder / word.substr(1)).string() : word);
  if (!arguments.empty() && arguments.front() == "run") {
    const auto give = [&](const std::string& option, const std::string& value) {
      if (std::ranges::find(arguments, option) == arguments.end())
        arguments.insert(arguments.end(), {option, value});
    };
    give("--display", "offscreen");
    give("--snapshot", folder / "snapshot.png");
    give("--report", folder / "report.json");
  }
  const auto begin = WallClock::now();
  const std::string said = run_refused(folder, arguments, GetParam().exit_status);
  EXPECT_LT(WallClock::now() - begin, 20s);
  for (const std::string& words : GetParam().told)
    EXPECT_THAT(said, HasSubstr(words));
}

INSTANTIATE_TEST_SUITE_P(All, BadInputs, testing::ValuesIn(bad_inputs()),
                         [](const auto& test) { return test.param.name; });

} // namespace
} // namespace octascope::tests
