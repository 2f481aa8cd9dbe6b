#include "firmware-host/configuration/kept/settings.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pipeline/files/config_document.h"
#include "pipeline/files/toml_text.h"

namespace octascope::firmware_host {

namespace {

using pipeline::ConfigTable;
using ui::ViewState;

// The names of an enumeration's values, in their order.
constexpr std::array<std::string_view, ui::layout_count> layouts{"volume", "b_scan", "microscope",
                                                                 "quad"};
constexpr std::array<std::string_view, ui::stereo_count> stereos{"off", "side_by_side",
                                                                 "top_bottom"};
constexpr std::array<std::string_view, ui::vessel_colouring_count> colourings{"branch", "order",
                                                                              "diagnostic"};

std::string name_in(std::span<const std::string_view> names, std::size_t index) {
  return pipeline::toml_text(names[index]);
}

template <class Enum>
void read_name(ConfigTable& table, std::string_view key, std::span<const std::string_view> names,
               Enum& value) {
  const std::string name = table.text(key, names[static_cast<std::size_t>(value)]);
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    table.complain(fmt::format("{} is \"{}\", expected one of: {}", key, name,
                               fmt::join(names.begin(), names.end(), ", ")));
  else
    value = static_cast<Enum>(found - names.begin());
}

void read_number(ConfigTable& table, std::string_view key, pipeline::NumberRange range,
                 float& value) {
  value = static_cast<float>(table.number(key, static_cast<double>(value), range));
}

void read_parameter(ConfigTable& table, std::string_view key, ui::Parameter parameter,
                    float& value) {
  const ui::ParameterRange range = ui::parameter_range(parameter, 1);
  read_number(table, key, {static_cast<double>(range.lowest), static_cast<double>(range.highest)},
              value);
}

struct Setting {
  std::string_view key;
  // As it stands in the file.
  std::string (*text)(const ViewState& view, const ui::TransferSet& set);
  // Leaves the view's where the key is not there, or names what there is no more.
  void (*read)(ConfigTable& table, std::string_view key, const ui::TransferSet& set,
               ViewState& view);
  void (*copy)(const ViewState& from, ViewState& to);
};

const std::array settings{
    Setting{
        "window_offset_db",
        [](const ViewState& v, const ui::TransferSet&) {
          return fmt::format("{:.2f}", v.window_offset_db);
        },
        [](ConfigTable& t, std::string_view key, const ui::TransferSet&, ViewState& v) {
          read_parameter(t, key, ui::Parameter::window_offset, v.window_offset_db);
        },
        [](const ViewState& from, ViewState& to) { to.window_offset_db = from.window_offset_db; }},
    Setting{"window_size_db",
            [](const ViewState& v, const ui::TransferSet&) {
              return fmt::format("{:.2f}", v.window_size_db);
            },
            [](ConfigTable& t, std::string_view key, const ui::TransferSet&, ViewState& v) {
              read_parameter(t, key, ui::Parameter::window_size, v.window_size_db);
            },
            [](const ViewState& from, ViewState& to) { to.window_size_db = from.window_size_db; }},
    Setting{"technique",
            [](const ViewState& v, const ui::TransferSet&) {
              return pipeline::toml_text(ui::to_string(v.technique));
            },
            [](ConfigTable& t, std::string_view key, const ui::TransferSet&, ViewState& v) {
              std::array<std::string_view, ui::all_techniques.size()> names;
              std::ranges::transform(ui::all_techniques, names.begin(),
                                     [](ui::Technique each) { return ui::to_string(each); });
              read_name(t, key, names, v.technique);
            },
            [](const ViewState& from, ViewState& to) { to.technique = from.technique; }},
    Setting{"transfer",
            [](const ViewState& v, const ui::TransferSet& set) {
              return pipeline::toml_text(set.function(v).name);
            },
            [](ConfigTable& t, std::string_view key, const ui::TransferSet& set, ViewState& v) {
              const std::string name = t.text(key, "");
              v.transfer = set.function_named(name).value_or(v.transfer);
            },
            [](const ViewState& from, ViewState& to) { to.transfer = from.transfer; }},
    Setting{"colours",
            [](const ViewState& v, const ui::TransferSet& set) {
              const auto maps = set.colour_maps();
              return pipeline::toml_text(maps[static_cast<std::size_t>(v.colour_map)].name());
            },
            [](ConfigTable& t, std::string_view key, const ui::TransferSet& set, ViewState& v) {
              const std::string name = t.text(key, "");
              v.colour_map = set.colour_map_named(name).value_or(v.colour_map);
            },
            [](const ViewState& from, ViewState& to) { to.colour_map = from.colour_map; }},
    Setting{"layout",
            [](const ViewState& v, const ui::TransferSet&) {
              return name_in(layouts, static_cast<std::size_t>(v.layout));
            },
            [](ConfigTable& t, std::string_view key, const ui::TransferSet&, ViewState& v) {
              read_name(t, key, layouts, v.layout);
            },
            [](const ViewState& from, ViewState& to) { to.layout = from.layout; }},
    Setting{"stereo",
            [](const ViewState& v, const ui::TransferSet&) {
              return name_in(stereos, static_cast<std::size_t>(v.stereo));
            },
            [](ConfigTable& t, std::string_view key, const ui::TransferSet&, ViewState& v) {
              read_name(t, key, stereos, v.stereo);
            },
            [](const ViewState& from, ViewState& to) { to.stereo = from.stereo; }},
    Setting{"parallax_deg",
            [](const ViewState& v, const ui::TransferSet&) {
              return fmt::format("{:.2f}", v.parallax_deg);
            },
            [](ConfigTable& t, std::string_view key, const ui::TransferSet&, ViewState& v) {
              read_parameter(t, key, ui::Parameter::parallax, v.parallax_deg);
            },
            [](const ViewState& from, ViewState& to) { to.parallax_deg = from.parallax_deg; }},
    Setting{
        "box",
        [](const ViewState& v, const ui::TransferSet&) { return fmt::format("{}", v.box_visible); },
        [](ConfigTable& t, std::string_view key, const ui::TransferSet&, ViewState& v) {
          v.box_visible = t.boolean(key, v.box_visible);
        },
        [](const ViewState& from, ViewState& to) { to.box_visible = from.box_visible; }},
    Setting{
        "vessels",
        [](const ViewState& v, const ui::TransferSet&) {
          return fmt::format("{}", v.vessels_visible);
        },
        [](ConfigTable& t, std::string_view key, const ui::TransferSet&, ViewState& v) {
          v.vessels_visible = t.boolean(key, v.vessels_visible);
        },
        [](const ViewState& from, ViewState& to) { to.vessels_visible = from.vessels_visible; }},
    Setting{"vessel_opacity",
            [](const ViewState& v, const ui::TransferSet&) {
              return fmt::format("{:.2f}", v.vessel_opacity);
            },
            [](ConfigTable& t, std::string_view key, const ui::TransferSet&, ViewState& v) {
              read_parameter(t, key, ui::Parameter::vessel_opacity, v.vessel_opacity);
            },
            [](const ViewState& from, ViewState& to) { to.vessel_opacity = from.vessel_opacity; }},
    Setting{
        "vessel_colours",
        [](const ViewState& v, const ui::TransferSet&) {
          return name_in(colourings, static_cast<std::size_t>(v.vessel_colouring));
        },
        [](ConfigTable& t, std::string_view key, const ui::TransferSet&, ViewState& v) {
          read_name(t, key, colourings, v.vessel_colouring);
        },
        [](const ViewState& from, ViewState& to) { to.vessel_colouring = from.vessel_colouring; }},
};

bool is_window(const Setting& setting) {
  return setting.key.starts_with("window_");
}

// What the configuration said of it; an automatic window has no number.
std::string configured_text(const Setting& setting, const ConfiguredView& configured) {
  return configured.automatic_window && is_window(setting)
             ? pipeline::toml_text("automatic")
             : setting.text(configured.view, configured.transfers);
}

// As the file has it; empty where it has none.
std::string read_configured(ConfigTable& table, const Setting& setting,
                            const ConfiguredView& configured) {
  if (!table.has(setting.key))
    return {};
  if (is_window(setting) && table.has_text(setting.key))
    return pipeline::toml_text(table.text(setting.key, ""));
  ViewState was = configured.view;
  setting.read(table, setting.key, configured.transfers, was);
  return setting.text(was, configured.transfers);
}

} // namespace

std::string settings_text(const ConfiguredView& configured, const ui::ViewState& state) {
  std::string set;
  std::string was;
  const auto changed = [&](const Setting& setting) {
    return setting.text(state, configured.transfers) !=
           setting.text(configured.view, configured.transfers);
  };
  const bool window_changed = std::ranges::any_of(
      settings, [&](const Setting& setting) { return is_window(setting) && changed(setting); });
  for (const Setting& setting : settings) {
    if (!(is_window(setting) ? window_changed : changed(setting))) // half a window is none
      continue;
    const std::string now = setting.text(state, configured.transfers);
    set += fmt::format("{} = {}\n", setting.key, now);
    was += fmt::format("{} = {}\n", setting.key, configured_text(setting, configured));
  }
  return fmt::format("# What pedal and knob have set; octascope writes this file.\n[settings]\n{}\n"
                     "# What the configuration said then: where it says something else now, that "
                     "counts.\n[configured]\n{}",
                     set, was);
}

hal::Result<RestoredView> read_settings(const std::filesystem::path& file,
                                        const ConfiguredView& configured) {
  HAL_TRY(const auto document, pipeline::ConfigDocument::load(file));
  ConfigTable set = document.root().table("settings");
  ConfigTable was = document.root().table("configured");
  RestoredView restored{configured.view};
  ViewState kept = configured.view;
  for (const Setting& setting : settings) {
    const bool there = set.has(setting.key);
    setting.read(set, setting.key, configured.transfers, kept);
    const std::string then = read_configured(was, setting, configured);
    if (!there || then != configured_text(setting, configured))
      continue;
    setting.copy(kept, restored.view);
    restored.window = restored.window || is_window(setting);
  }
  HAL_CHECK(document.finish());
  return restored;
}

} // namespace octascope::firmware_host
