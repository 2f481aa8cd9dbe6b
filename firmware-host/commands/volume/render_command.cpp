#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/commands/spectra_type.h"
#include "firmware-host/commands/tree_options.h"
#include "firmware-host/commands/volume/flow_file.h"
#include "firmware-host/commands/volume/render.h"
#include "firmware-host/configuration/configuration.h"
#include "firmware-host/run/volume_source.h"
#include "firmware-host/terminal/terminal.h"
#include "firmware-host/vessels/vessel_patient_check.h"
#include "firmware-host/vessels/vessel_place.h"
#include "pipeline/files/atomic_file.h"
#include "pipeline/vessels/registration.h"
#include "sim/phantoms/phantom.h"

namespace octascope::firmware_host {

namespace {

// As text, the way CLI11 collects it; what is not given stays as RenderOptions and ViewState begin.
struct RenderArguments {
  std::string configuration, volume, flow, spectra, shape, calibration, phantom;
  SpectraTypeArguments type;
  std::string technique, size, window, transfer, colours, vessels, registration;
  std::string stereo = "off", drawn_by = "auto", out;
  ui::ViewState view = [] {
    ui::ViewState begin;
    begin.box_visible = false;
    return begin;
  }();
  int steps = ui::full_quality.steps;
  std::string vessel_colours = "branch";
  TreeArguments tree;
  std::size_t volume_number = 0;
  CLI::Option* at = nullptr;      // whether one was said
  std::string cut_at;             // B-scan, and A-scan if a corner is cut
  CLI::Option* cut = nullptr;     // likewise
  CLI::Option* opacity = nullptr; // the configuration may say another
};

const std::map<std::string, ui::StereoMode>& stereo_modes() {
  static const std::map<std::string, ui::StereoMode> all{
      {"off", ui::StereoMode::off},
      {"side-by-side", ui::StereoMode::side_by_side},
      {"top-bottom", ui::StereoMode::top_bottom}};
  return all;
}

const std::map<std::string, std::optional<ui::RayBackend>>& drawers() {
  static const std::map<std::string, std::optional<ui::RayBackend>> all{
      {"auto", std::nullopt},
      {"processor", ui::RayBackend::processor},
      {"gl", ui::RayBackend::shader}};
  return all;
}

const std::map<std::string, ui::VesselColouring>& vessel_colourings() {
  static const std::map<std::string, ui::VesselColouring> all{
      {"branch", ui::VesselColouring::branch}, {"order", ui::VesselColouring::order}};
  return all;
}

CLI::Validator within_range_of(ui::Action action) {
  const ui::NumberRange range = range_of(action);
  return within(range.lowest, range.highest);
}

hal::Result<VolumeRequest> request_of(const RenderArguments& a) {
  VolumeRequest request;
  if (!a.volume.empty())
    request.file = a.volume;
  if (a.at->count() > 0)
    request.at = a.volume_number;
  if (!a.phantom.empty())
    request.phantom = a.phantom;
  if (!a.calibration.empty())
    request.calibration = a.calibration;
  if (a.spectra.empty())
    return request;
  HAL_TRY(request.recording, recording_options(a.spectra, a.shape, a.type));
  return request;
}

// The place of the item with that name.
template <typename Items>
hal::Result<int> index_named(std::string_view option, const std::string& name, const Items& items,
                             auto&& name_of) {
  std::string names;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (name_of(items[i]) == name)
      return static_cast<int>(i);
    names += fmt::format("{}{}", i == 0 ? "" : ", ", name_of(items[i]));
  }
  return hal::fail(hal::ErrorCode::invalid_argument, "{} is \"{}\", expected one of {}", option,
                   name, names);
}

// The look of the configuration, and over it what the command line says.
hal::Result<> read_look(const RenderArguments& a, RenderOptions& options) {
  if (!a.configuration.empty()) {
    HAL_TRY(const auto configuration, load_configuration(a.configuration));
    const LookConfiguration& look = configuration.look;
    options.transfers = look.transfers;
    options.view.transfer = look.transfer;
    options.view.colour_map = look.colour_map;
    options.view.technique = look.technique;
    if (a.opacity->empty())
      options.view.opacity = look.opacity;
    options.window = configuration.window;
  }
  if (!a.technique.empty())
    options.view.technique = *ui::technique_named(a.technique);
  if (!a.transfer.empty()) {
    HAL_TRY(const auto index, index_named("--transfer", a.transfer, options.transfers.functions(),
                                          [](const ui::TransferFunction& f) { return f.name; }));
    options.view.transfer = index;
  }
  if (!a.colours.empty()) {
    HAL_TRY(const auto index, index_named("--colours", a.colours, options.transfers.colour_maps(),
                                          [](const ui::ColourMap& m) { return m.name(); }));
    options.view.colour_map = index;
  }
  return {};
}

// B-scan, or B-scan and A-scan.
hal::Result<> read_cut(std::string_view text, ui::ViewState& view) {
  const std::size_t comma = text.find(',');
  const auto b_scan = hal::number_of<int>(text.substr(0, comma));
  view.cut = comma == text.npos ? ui::CutShape::b_scan : ui::CutShape::corner;
  const auto a_scan =
      comma == text.npos ? std::optional<int>{0} : hal::number_of<int>(text.substr(comma + 1));
  if (!b_scan || *b_scan < 0 || !a_scan || *a_scan < 0)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "--cut is \"{}\", expected a B-scan, or a B-scan and an A-scan, counted from "
                     "0, as in 44 or 44,150",
                     text);
  view.b_scan = *b_scan;
  if (view.cut == ui::CutShape::corner)
    view.a_scan = *a_scan;
  return {};
}

hal::Result<RenderOptions> options_of(const RenderArguments& a) {
  RenderOptions options;
  options.view = a.view;
  HAL_CHECK(read_look(a, options));
  if (!a.cut->empty()) {
    HAL_CHECK(read_cut(a.cut_at, options.view));
  }
  options.view.stereo = stereo_modes().at(a.stereo);
  options.view.vessel_colouring = vessel_colourings().at(a.vessel_colours);
  options.quality.steps = a.steps;
  options.quality.rays = drawers().at(a.drawn_by);
  if (!a.window.empty()) {
    HAL_TRY(const auto window, parse_window(a.window));
    options.window = window;
  }
  if (!a.size.empty()) {
    HAL_TRY(const auto size, parse_size(a.size));
    options.width = size[0];
    options.height = size[1];
  }
  return options;
}

struct RenderVessels {
  std::optional<LoadedVessels> tree;
  std::optional<ui::PlacedVessels> placed; // borrows from it
};

hal::Result<RenderVessels> vessels_of(const RenderArguments& a,
                                      const pipeline::PatientEye& picture) {
  RenderVessels vessels;
  if (a.vessels.empty())
    return vessels;
  std::optional<pipeline::RigidTransform> registered;
  if (!a.registration.empty()) {
    HAL_TRY(const auto registration, pipeline::Registration::load(a.registration));
    HAL_CHECK(check_vessel_patient(a.registration, registration.whose, picture));
    registered = registration.volume_from_tree;
  }
  HAL_TRY(auto loaded, load_vessels(a.vessels, a.tree.options()));
  vessels.tree.emplace(std::move(loaded));
  vessels.placed = place_vessels(*vessels.tree, registered);
  return vessels;
}

hal::Result<> render(const RenderArguments& arguments) {
  HAL_TRY(auto options, options_of(arguments));
  HAL_TRY(const auto request, request_of(arguments));
  // Said before the work, not after it.
  HAL_CHECK(pipeline::AtomicFile::create(arguments.out));
  HAL_TRY(auto loaded, load_volume(request));
  if (!arguments.flow.empty())
    HAL_CHECK(read_flow_beside(arguments.flow, loaded.volume));
  for (const std::string& remark : loaded.remarks)
    warn("octascope render: {}\n", remark);
  HAL_TRY(const auto vessels, vessels_of(arguments, loaded.whose));
  if (vessels.placed && !vessels.placed->volume_from_tree)
    warn("octascope render: {} is not registered: it lies in the middle of the "
         "volume (--registration)\n",
         arguments.vessels);
  options.vessels = vessels.placed;
  HAL_TRY(const auto picture, render_volume(loaded.volume, options));
  return pipeline::write_png(arguments.out, picture);
}

int run(const RenderArguments& arguments) {
  const auto done = render(arguments);
  return done ? exit_done : complain("render", done.error());
}

void add_volume_options(CLI::App& command, RenderArguments& a) {
  CLI::Option* volume =
      command
          .add_option(
              "--volume", a.volume,
              "Volume to draw: NRRD with levels in dB, depth fastest, or a recording (HDF5)")
          ->type_name("FILE");
  a.at = command
             .add_option("--at", a.volume_number,
                         "Which volume of a recording, counted from 0 (0 if not given)")
             ->check(within(0, 1000000000))
             ->needs(volume);
  command
      .add_option("--flow", a.flow,
                  "What flows in it, drawn in colour: NRRD of the same shape, from 0 (static) to 1 "
                  "(flowing), as reconstruct --flow writes it")
      ->type_name("FILE.nrrd")
      ->needs(volume);
  CLI::Option* spectra =
      command
          .add_option("--spectra", a.spectra,
                      "Or raw spectra (little-endian, [B][A][N], or a recording of them), "
                      "reconstructed as run does")
          ->type_name("FILE");
  command.add_option("--shape", a.shape, "B-scans,A-scans,samples of --spectra, as 100,100,1024")
      ->type_name("B,A,N")
      ->needs(spectra);
  add_spectra_type_options(command, a.type, spectra);
  command.add_option("--calibration", a.calibration, "Calibration of the spectrometer (TOML)")
      ->type_name("FILE.toml")
      ->needs(spectra);
  command.add_option("--phantom", a.phantom, "Or what a simulated camera sees")
      ->check(CLI::IsMember(
          std::vector<std::string>(sim::phantom_names.begin(), sim::phantom_names.end())));
}

void add_look_options(CLI::App& command, RenderArguments& a) {
  std::vector<std::string> techniques;
  for (const ui::Technique technique : ui::all_techniques)
    techniques.emplace_back(to_string(technique));
  command.add_option("--technique", a.technique, "How the volume is drawn (rays if not given)")
      ->check(CLI::IsMember(techniques));
  command.add_option("--yaw", a.view.yaw_deg, "Degrees about the depth axis")
      ->check(within_range_of(ui::Action::rotate))
      ->capture_default_str();
  command.add_option("--tilt", a.view.tilt_deg, "Degrees above the surface's plane")
      ->check(within_range_of(ui::Action::tilt))
      ->capture_default_str();
  command.add_option("--distance", a.view.distance, "In half-diagonals of the volume")
      ->check(within_range_of(ui::Action::distance))
      ->capture_default_str();
  command
      .add_option("--window", a.window,
                  "Where the display window begins and its size, in dB, as 8,36; what suits the "
                  "volume if not given")
      ->type_name("L,S");
  a.opacity = command
                  .add_option("--opacity", a.view.opacity,
                              "Of a voxel at the top of the window (0.5 if not given)")
                  ->check(within(0.01F, 1.0F));
  command
      .add_option("--see-through", a.view.see_through_db,
                  "dB by which tissue that covers other tissue is drawn weaker")
      ->check(within_range_of(ui::Action::see_through))
      ->capture_default_str();
  a.cut = command
              .add_option(
                  "--cut", a.cut_at,
                  "Cut the volume open at this B-scan, or at this one and this A-scan: a corner "
                  "is left out; counted from 0, as 44 or 44,150")
              ->type_name("B[,A]");
  command.add_option("--transfer", a.transfer,
                     "Transfer function: window, smooth, surface or the configuration's own");
  command.add_option("--colours", a.colours, "Colour map: grey, amber, blue-green, dawn or depth");
  command
      .add_option("--config", a.configuration,
                  "Configuration with transfer functions; its technique, opacity, colours and "
                  "window hold where the command line does not say otherwise")
      ->type_name("FILE.toml");
}

void add_vessel_options(CLI::App& command, RenderArguments& a) {
  CLI::Option* vessels =
      command
          .add_option("--vessels", a.vessels, "Vessel tree to draw in the volume: ours, SWC or VTP")
          ->type_name("FILE");
  command
      .add_option("--registration", a.registration,
                  "Where the tree lies in the volume; in its middle if not given")
      ->type_name("FILE.toml")
      ->needs(vessels);
  command
      .add_option("--vessel-opacity", a.view.vessel_opacity, "0 shows none, 1 hides what is behind")
      ->check(within_range_of(ui::Action::vessel_opacity))
      ->needs(vessels)
      ->capture_default_str();
  std::vector<std::string> colourings;
  for (const auto& [word, value] : vessel_colourings())
    colourings.push_back(word);
  command.add_option("--vessel-colours", a.vessel_colours, "By main branch or by order")
      ->check(CLI::IsMember(colourings))
      ->needs(vessels)
      ->capture_default_str();
  add_tree_options(command, a.tree);
}

void add_picture_options(CLI::App& command, RenderArguments& a) {
  const auto words = [](const auto& named) {
    std::vector<std::string> all;
    for (const auto& [word, value] : named)
      all.push_back(word);
    return all;
  };
  command.add_option("--size", a.size, "Size of the picture in pixels (1280x720 if not given)")
      ->type_name("WxH");
  CLI::Option* stereo = command.add_option("--stereo", a.stereo, "A picture for each eye")
                            ->check(CLI::IsMember(words(stereo_modes())))
                            ->capture_default_str();
  command.add_option("--parallax", a.view.parallax_deg, "Degrees between the eyes")
      ->check(within_range_of(ui::Action::parallax))
      ->needs(stereo);
  command.add_option("--steps", a.steps, "Samples along the longest edge of the volume")
      ->check(within(1, 4096))
      ->capture_default_str();
  command
      .add_option("--drawn-by", a.drawn_by,
                  "Who casts rays: auto takes the processor where GL is software")
      ->check(CLI::IsMember(words(drawers())))
      ->capture_default_str();
  command.add_flag("--box", a.view.box_visible, "Draw the wire-frame box");
  command.add_option("--out", a.out, "Picture to write")->required()->type_name("FILE.png");
}

} // namespace

void add_render_command(CLI::App& program, int& exit_status) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = program.add_subcommand("render", "A picture of a volume (PNG)");
  add_volume_options(*command, *arguments);
  add_look_options(*command, *arguments);
  add_vessel_options(*command, *arguments);
  add_picture_options(*command, *arguments);
  command->footer("Examples:\n"
                  "  octascope render --volume volume.nrrd --technique shaded --size 1920x1080 \\\n"
                  "    --yaw 30 --tilt 40 --distance 2.5 --window 8,36 --out volume.png\n"
                  "  octascope render --volume volume.nrrd --flow flow.nrrd --opacity 0.1 \\\n"
                  "    --out flow.png\n"
                  "  octascope render --volume eye.h5 --at 12 --out eye.png\n"
                  "  octascope render --phantom anterior_eye --technique maximum --out eye.png\n"
                  "  octascope render --spectra spectra.raw --shape 100,100,1024 \\\n"
                  "    --calibration spectrometer.toml --stereo side-by-side --out tissue.png\n"
                  "  octascope render --volume volume.nrrd --vessels heart.vessels \\\n"
                  "    --registration registration.toml --vessel-opacity 0.7 --out vessels.png");
  command->callback([arguments, &exit_status] { exit_status = run(*arguments); });
}

} // namespace octascope::firmware_host
