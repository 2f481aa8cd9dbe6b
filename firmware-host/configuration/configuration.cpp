#include "firmware-host/configuration/configuration.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware-host/configuration/control_device_file.h"
#include "hal/linux/aravis/genicam_address.h"

namespace octascope::firmware_host {

namespace {

using pipeline::ConfigTable;
using pipeline::NumberRange;

void read_scan(ConfigTable root, Configuration& configuration) {
  const bool present = root.has("scan");
  ConfigTable scan = root.table("scan");
  pipeline::ScanPlan plan;
  const NumberRange counts{1, 65536};
  const NumberRange spacings_um{1e-3, 1e6};
  plan.samples = scan.integer("samples", plan.samples, {16, 65536});
  plan.a_scans = scan.integer("a_scans", plan.a_scans, counts);
  plan.fly_back_lines = scan.integer("fly_back_lines", plan.fly_back_lines, {0, 65536});
  plan.b_scans = scan.integer("b_scans", plan.b_scans, counts);
  plan.line_rate_hz = scan.number("line_rate_hz", plan.line_rate_hz, {1, 1e9});
  plan.depth_spacing_um = scan.number("depth_spacing_um", plan.depth_spacing_um, spacings_um);
  configuration.depth_spacing_said = scan.has("depth_spacing_um");
  plan.a_spacing_um = scan.number("a_spacing_um", plan.a_spacing_um, spacings_um);
  plan.b_spacing_um = scan.number("b_spacing_um", plan.b_spacing_um, spacings_um);
  plan.assumed_spacings = {!configuration.depth_spacing_said, !scan.has("a_spacing_um"),
                           !scan.has("b_spacing_um")};
  plan.bidirectional = scan.boolean("bidirectional", plan.bidirectional);
  plan.turn_around_lines = scan.integer("turn_around_lines", plan.turn_around_lines, {0, 65536});
  plan.scan_lag_a_scans =
      scan.number("phase_offset_a_scans", plan.scan_lag_a_scans,
                  {-static_cast<double>(plan.a_scans), static_cast<double>(plan.a_scans)});
  plan.find_scan_lag = scan.boolean("find_phase_offset", plan.find_scan_lag);
  plan.repeats = scan.integer("repeats", plan.repeats, {1, pipeline::ScanPlan::most_repeats});
  if (present)
    configuration.plan = plan;
}

void read_worker_cores(ConfigTable table, Configuration& configuration) {
  constexpr double highest_core = 1023; // of the sets that the system takes
  for (const double core : table.numbers("worker_cores")) {
    if (core < 0 || core > highest_core || core != std::floor(core)) {
      table.complain("worker_cores must be core numbers from 0 to 1023, as in [2, 3]");
      return;
    }
    configuration.worker_cores.push_back(static_cast<int>(core));
  }
}

void read_pipeline(ConfigTable table, Configuration& configuration) {
  configuration.workers = static_cast<std::size_t>(table.integer("workers", 0, {0, 256}));
  read_worker_cores(table, configuration);
  configuration.flow = table.boolean("flow", configuration.flow);
  const auto weights = table.numbers("neighbour_weights");
  if (weights.empty())
    return;
  if (weights.size() != 3 || weights[1] <= 0 || weights[0] < 0 || weights[2] < 0) {
    table.complain("neighbour_weights must be three numbers, before, own (> 0) and after, as in "
                   "[0.25, 0.5, 0.25]");
    return;
  }
  configuration.neighbour_weights = {weights[0], weights[1], weights[2]};
}

enum class OtherWords { refused, allowed }; // allowed: a node's name, an id

std::string read_device(ConfigTable& table, const char* key, std::string_view fallback,
                        std::initializer_list<std::string_view> known, OtherWords others) {
  std::string wanted = table.text(key, std::string{fallback});
  const bool is_known = std::ranges::find(known, wanted) != known.end();
  if (!is_known && (others == OtherWords::refused || wanted.empty()))
    table.complain("{} is \"{}\", expected one of: {}", key, wanted, fmt::join(known, ", "));
  return wanted;
}

void read_devices(ConfigTable table, DeviceConfig& config) {
  config.line_camera = read_device(table, "line_camera", config.line_camera,
                                   {"auto", "sim", "v4l2", "usb3vision"}, OtherWords::allowed);
  if (const auto genicam = hal::linux_backend::parse_genicam_address(config.line_camera); !genicam)
    table.complain("line_camera: {}", genicam.error().message);
  config.galvo_trigger = read_device(table, "galvo_trigger", config.galvo_trigger,
                                     {"auto", "sim", "gpio"}, OtherWords::refused);
  config.control_input = read_device(table, "control_input", config.control_input,
                                     {"auto", "sim", "hid"}, OtherWords::refused);
  config.scope_camera = read_device(table, "scope_camera", config.scope_camera,
                                    {"auto", "sim", "none", "libcamera"}, OtherWords::allowed);
  config.trigger_line = table.text("trigger_line", config.trigger_line);
  config.sync_line = table.text("sync_line", config.sync_line);
  config.pulse_width = hal::from_seconds(
      table.number("pulse_width_us", hal::to_seconds(config.pulse_width) * 1e6, {1, 1e5}) * 1e-6);
  config.connector = table.text("connector", config.connector);
  config.mode = table.text("mode", config.mode);
  config.overscan_percent = table.number("overscan_percent", config.overscan_percent, {0, 20});
  config.seat = table.boolean("seat", config.seat);
  if (table.has("exposure_us"))
    config.exposure_us = table.number("exposure_us", 1, {0.01, 1e6});
  if (table.has("gain"))
    config.gain = table.integer("gain", 0, {-1000000, 1000000});
  if (table.has("camera_input"))
    config.camera_input = table.integer("camera_input", 0, {0, 255});
  config.camera_trigger = table.text("camera_trigger", config.camera_trigger);
  config.packet_resend = table.boolean("packet_resend", config.packet_resend);
  if (table.has("significant_bits"))
    config.significant_bits = table.integer("significant_bits", 12, {8, 16});
  config.right_shift = table.integer("right_shift", config.right_shift, {0, 8});
}

void read_display(ConfigTable table, Configuration& configuration) {
  configuration.width = table.integer("width", configuration.width, {320, 16384});
  configuration.height = table.integer("height", configuration.height, {180, 16384});
  configuration.fullscreen = table.boolean("fullscreen", configuration.fullscreen);
  configuration.window = read_window(table);
  configuration.veil_after = hal::from_seconds(
      table.number("veil_after_s", hal::to_seconds(configuration.veil_after), {0.5, 3600}));
}

std::optional<ui::Side> read_side(ConfigTable& table, const char* key) {
  if (!table.has(key))
    return std::nullopt;
  const std::string said = table.text(key, "");
  const auto side = ui::side_named(said);
  if (!side)
    table.complain("{} is \"{}\", expected one of: superior, inferior, nasal, temporal", key, said);
  return side;
}

void read_orientation(ConfigTable table, ui::ScanOrientation& orientation) {
  constexpr std::size_t longest_label = 12; // bytes: what finds room beside the cube
  ui::ScanOnEye& scan = orientation.on_eye;
  scan = {read_side(table, "right_eye_x"), read_side(table, "right_eye_y")};
  if (table.has("right_eye_x") != table.has("right_eye_y"))
    table.complain("right_eye_x and right_eye_y belong together, expected both or none: where x "
                   "and y of the scan point to on a right eye");
  else if (scan.right_eye_x && scan.right_eye_y &&
           ui::along_one_line(*scan.right_eye_x, *scan.right_eye_y))
    table.complain("right_eye_x is \"{}\" and right_eye_y is \"{}\", which lie on one line, "
                   "expected one of superior and inferior, and one of nasal and temporal",
                   ui::to_string(*scan.right_eye_x), ui::to_string(*scan.right_eye_y));
  constexpr std::array keys{"x_label", "y_label", "z_label"};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    std::string& name = orientation.labels.names[i];
    name = table.text(keys[i], "");
    if (name.size() > longest_label)
      table.complain("{} is \"{}\", {} bytes long, expected at most {}: it stands beside the "
                     "cube of orientation",
                     keys[i], name, name.size(), longest_label);
  }
}

// In lower case, as the kernel writes them.
void read_keyboards(ConfigTable& table, DeviceConfig& config) {
  for (const std::string& written : table.texts("keyboards")) {
    std::string usb = written;
    std::ranges::transform(usb, usb.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::string_view digits = "0123456789abcdef";
    if (usb.size() != 9 || usb[4] != ':' || usb.find_first_not_of(digits) != 4 ||
        usb.find_first_not_of(digits, 5) != usb.npos)
      table.complain("keyboards has \"{}\", expected vendor and product as \"046d:c31c\"; "
                     "`octascope devices` names those of each keyboard",
                     written);
    config.keyboards.push_back(std::move(usb));
  }
}

void read_controls(ConfigTable table, Configuration& configuration) {
  if (table.has("profile") && table.has("file"))
    table.complain("profile and file are both there, expected one: the name of a profile that the "
                   "program brings with it, or the file of your own");
  configuration.control_file = table.path("file");
  read_keyboards(table, configuration.devices);
  configuration.devices.control_device = table.path("device");
  if (const auto& device = configuration.devices.control_device)
    if (const auto learned = load_control_device(*device); !learned)
      table.complain(learned.error().message);
  const std::string profile = table.text("profile", "auto");
  if (profile == "auto")
    return;
  configuration.control_profile = profile;
  if (const auto known = ui::built_in_profile(profile); !known)
    table.complain(known.error().message);
}

// What is written there must not be in the way: it would be noticed when it is needed.
void read_outputs(ConfigTable observation, ConfigTable recordings, Configuration& configuration) {
  std::error_code error;
  configuration.metrics = observation.output_path("metrics");
  if (configuration.metrics && std::filesystem::is_directory(*configuration.metrics, error))
    observation.complain("metrics is {}, which is a folder, expected the name of a file",
                         configuration.metrics->string());
  configuration.recording_folder = recordings.output_path("folder");
  const auto& folder = configuration.recording_folder;
  if (folder && std::filesystem::exists(*folder, error) &&
      !std::filesystem::is_directory(*folder, error))
    recordings.complain("folder is {}, which is a file, expected a folder, made where missing",
                        folder->string());
}

std::vector<sim::MotionTone> read_tones(ConfigTable& table, std::string_view key) {
  std::vector<sim::MotionTone> tones;
  for (const auto& row : table.rows(key, 2))
    tones.push_back({.amplitude_um = row[0], .frequency_hz = row[1]});
  return tones;
}

void read_sim(ConfigTable table, Configuration& configuration) {
  configuration.phantom = table.text("phantom", configuration.phantom);
  configuration.loop_volumes = table.integer("loop_volumes", configuration.loop_volumes, {1, 64});
  configuration.galvo_lag_us = table.number("galvo_lag_us", configuration.galvo_lag_us, {0, 1e6});
  configuration.tissue_motion = {.axial = read_tones(table, "axial_motion"),
                                 .lateral = read_tones(table, "lateral_motion")};
  if (const auto possible = configuration.tissue_motion.validate(); !possible)
    table.complain(possible.error().message);
  configuration.faults = table.path("faults");
  configuration.controls = table.path("controls");
}

// What the lens decides comes before what is said of every lens.
void read_optics(ConfigTable root, Configuration& configuration) {
  configuration.objectives = read_objectives(root);
  configuration.objective = chosen_objective(root.table("microscope"), configuration.objectives);
  if (!configuration.objective)
    return;
  if (configuration.objective->calibration)
    configuration.calibration = configuration.objective->calibration;
  if (configuration.objective->window)
    configuration.window = configuration.objective->window;
}

} // namespace

void override_plan(const RunOptions& options, const Configuration& configuration,
                   pipeline::ScanPlan& plan) {
  if (configuration.objective)
    configuration.objective->scale(plan);
  plan.bidirectional |= options.bidirectional;
  plan.repeats = options.repeats.value_or(plan.repeats);
}

std::optional<std::filesystem::path> configuration_file(const RunOptions& options) {
  if (options.configuration || options.simulate || options.recording)
    return options.configuration;
  std::error_code error;
  if (!std::filesystem::exists(machine_configuration, error))
    return std::nullopt;
  return machine_configuration;
}

std::string configuration_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream{file, std::ios::binary}.rdbuf();
  return text.str();
}

hal::Result<Configuration> load_configuration(const std::filesystem::path& file) {
  return pipeline::ConfigDocument::load(file).and_then(read_configuration);
}

hal::Result<Configuration> read_configuration(const pipeline::ConfigDocument& document) {
  Configuration configuration;
  ConfigTable root = document.root();
  read_scan(root, configuration);
  configuration.calibration = root.table("calibration").path("file");
  read_pipeline(root.table("pipeline"), configuration);
  read_devices(root.table("devices"), configuration.devices);
  ConfigTable display = root.table("display");
  read_display(display, configuration);
  configuration.look = read_look(root, display);
  read_orientation(root.table("orientation"), configuration.orientation);
  read_controls(root.table("controls"), configuration);
  read_outputs(root.table("observation"), root.table("recordings"), configuration);
  read_sim(root.table("sim"), configuration);
  read_optics(root, configuration);
  HAL_CHECK(document.finish());
  return configuration;
}

hal::Result<Configuration> configuration_of(const RunOptions& options) {
  const auto file = configuration_file(options);
  return file ? load_configuration(*file) : Configuration{};
}

pipeline::ScanPlan plan_of(const RunOptions& options, const Configuration& configuration) {
  pipeline::ScanPlan nothing_said;
  nothing_said.assumed_spacings = {true, true, true};
  pipeline::ScanPlan plan = configuration.plan.value_or(nothing_said);
  override_plan(options, configuration, plan);
  return plan;
}

bool tells_flow(const RunOptions& options, const Configuration& configuration) {
  return options.flow.value_or(configuration.flow);
}

hal::Result<ui::ControlProfile> load_controls(const Configuration& configuration) {
  return configuration.control_file ? ui::ControlProfile::load(*configuration.control_file)
                                    : ui::built_in_profile(configuration.control_profile.value_or(
                                          std::string{ui::default_profile}));
}

} // namespace octascope::firmware_host
