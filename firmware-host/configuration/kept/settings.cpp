#include "firmware-host/configuration/kept/settings.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "pipeline/files/config_document.h"
#include "pipeline/files/toml_text.h"
#include "ui/view/action_table.h"

namespace octascope::firmware_host {

namespace {

using pipeline::ConfigTable;
using ui::ActionRow;
using ui::ViewState;

bool is_setting(const ActionRow& row) {
  return row.has(ui::trait::kept);
}

// As it stands in the file.
std::string text_of(const ActionRow& row, const ViewState& view, const ui::ChoiceNames& names) {
  return std::visit(
      ui::Overloaded{
          [](const ui::NoValue&) { return std::string{}; },
          [&](const ui::Number& v) { return fmt::format("{:.2f}", v.of(view)); },
          [&](const ui::Flag& v) { return fmt::format("{}", view.*v.flag); },
          [&](const ui::Choice& v) { return pipeline::toml_text(v.values[v.of(view)].name); },
          [&](const ui::NamedChoice& v) {
            const std::vector<std::string>& all = names.*v.names;
            const auto index = static_cast<std::size_t>(view.*v.index);
            return pipeline::toml_text(index < all.size() ? all[index] : all.front());
          },
      },
      row.value);
}

void read_choice(ConfigTable& table, std::string_view key, const ui::Choice& choice,
                 ViewState& view) {
  const std::string name = table.text(key, choice.values[choice.of(view)].name);
  const auto found = std::ranges::find(choice.values, name, &ui::ChoiceValue::name);
  if (found != choice.values.end()) {
    choice.set(view, static_cast<std::size_t>(found - choice.values.begin()));
    return;
  }
  std::string known;
  for (const ui::ChoiceValue& value : choice.values)
    known += fmt::format("{}{}", known.empty() ? "" : ", ", value.name);
  table.complain("{} is \"{}\", expected one of: {}", key, name, known);
}

// Vessels were either shown or not before there was flow: files of then still say so.
bool read_old_vessels(ConfigTable& table, const ActionRow& row, ViewState& view) {
  if (row.action != ui::Action::vessels || !table.has_boolean(row.key))
    return false;
  view.vessels = table.boolean(row.key, true) ? ui::VesselsShown::both : ui::VesselsShown::off;
  return true;
}

// Leaves the view's where the key is not there, or names what there is no more.
void read(ConfigTable& table, const ActionRow& row, const ui::ChoiceNames& names, ViewState& view) {
  std::visit(ui::Overloaded{
                 [](const ui::NoValue&) {},
                 [&](const ui::Number& v) {
                   const ui::NumberRange range = ui::range_of(row.action);
                   v.set(view,
                         static_cast<float>(table.number(row.key, static_cast<double>(v.of(view)),
                                                         {static_cast<double>(range.lowest),
                                                          static_cast<double>(range.highest)})));
                 },
                 [&](const ui::Flag& v) { view.*v.flag = table.boolean(row.key, view.*v.flag); },
                 [&](const ui::Choice& v) {
                   if (!read_old_vessels(table, row, view))
                     read_choice(table, row.key, v, view);
                 },
                 [&](const ui::NamedChoice& v) {
                   const std::vector<std::string>& all = names.*v.names;
                   const auto found = std::ranges::find(all, table.text(row.key, ""));
                   if (found != all.end())
                     view.*v.index = static_cast<int>(found - all.begin());
                 },
             },
             row.value);
}

// What the configuration said of it; an automatic window has no number.
std::string configured_text(const ActionRow& row, const ConfiguredView& configured,
                            const ui::ChoiceNames& names) {
  return configured.automatic_window && ui::changes_window(row.action)
             ? pipeline::toml_text("automatic")
             : text_of(row, configured.view, names);
}

// As the file has it; empty where it has none.
std::string read_configured(ConfigTable& table, const ActionRow& row,
                            const ConfiguredView& configured, const ui::ChoiceNames& names) {
  if (!table.has(row.key))
    return {};
  if (ui::changes_window(row.action) && table.has_text(row.key))
    return pipeline::toml_text(table.text(row.key, ""));
  ViewState was = configured.view;
  read(table, row, names, was);
  return text_of(row, was, names);
}

} // namespace

std::string settings_text(const ConfiguredView& configured, const ui::ViewState& state) {
  const ui::ChoiceNames names = configured.transfers.names();
  std::string set;
  std::string was;
  const auto changed = [&](const ActionRow& row) {
    return is_setting(row) && text_of(row, state, names) != text_of(row, configured.view, names);
  };
  const bool window_changed = std::ranges::any_of(ui::action_table(), [&](const ActionRow& row) {
    return ui::changes_window(row.action) && changed(row);
  });
  for (const ActionRow& row : ui::action_table()) {
    const bool of_window = is_setting(row) && ui::changes_window(row.action);
    if (!(of_window ? window_changed : changed(row))) // half a window is none
      continue;
    set += fmt::format("{} = {}\n", row.key, text_of(row, state, names));
    was += fmt::format("{} = {}\n", row.key, configured_text(row, configured, names));
  }
  return fmt::format("# What pedal and knob have set; octascope writes this file.\n[settings]\n{}\n"
                     "# What the configuration said then: where it says something else now, that "
                     "counts.\n[configured]\n{}",
                     set, was);
}

hal::Result<RestoredView> read_settings(const std::filesystem::path& file,
                                        const ConfiguredView& configured) {
  HAL_TRY(const auto document, pipeline::ConfigDocument::load(file));
  const ui::ChoiceNames names = configured.transfers.names();
  ConfigTable set = document.root().table("settings");
  ConfigTable was = document.root().table("configured");
  RestoredView restored{configured.view};
  ViewState kept = configured.view;
  for (const ActionRow& row : ui::action_table()) {
    if (!is_setting(row))
      continue;
    const bool there = set.has(row.key);
    read(set, row, names, kept);
    const std::string then = read_configured(was, row, configured, names);
    if (!there || then != configured_text(row, configured, names))
      continue;
    std::visit([&](const auto& value) { value.copy(kept, restored.view); }, row.value);
    restored.window = restored.window || ui::changes_window(row.action);
  }
  HAL_CHECK(document.finish());
  return restored;
}

} // namespace octascope::firmware_host
