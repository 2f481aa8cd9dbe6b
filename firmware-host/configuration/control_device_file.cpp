#include "firmware-host/configuration/control_device_file.h"

#include <fmt/format.h>

#include "hal/number_text.h"
#include "pipeline/files/config_document.h"

namespace octascope::firmware_host {

using hal::linux_backend::ControlModel;
using hal::linux_backend::HidFamily;
using pipeline::ConfigTable;

namespace {

std::optional<std::uint16_t> hex4(std::string_view text) {
  return text.size() == 4 ? hal::number_of<std::uint16_t>(text, 16) : std::nullopt;
}

void read_usb(ConfigTable& root, ControlModel& model) {
  const std::string usb = root.text("usb", "");
  const auto vendor = usb.size() == 9 && usb[4] == ':' ? hex4(usb.substr(0, 4)) : std::nullopt;
  const auto product = vendor ? hex4(usb.substr(5)) : std::nullopt;
  if (!product)
    root.complain("usb is \"{}\", expected vendor and product as \"05f3:00ff\"", usb);
  model.vendor = vendor.value_or(0);
  model.product = product.value_or(0);
}

void read_switch(ConfigTable& entry, ControlModel& model) {
  if (entry.has("key") == entry.has("byte") || entry.has("byte") != entry.has("mask"))
    entry.complain("expected either key, or byte and mask");
  if (entry.has("key"))
    model.keys.push_back(static_cast<std::uint16_t>(entry.integer("key", 0, {1, 767})));
  else
    model.bits.push_back({static_cast<std::size_t>(entry.integer("byte", 0, {0, 255})),
                          static_cast<std::uint8_t>(entry.integer("mask", 1, {1, 255}))});
}

hal::Result<ControlModel> read(const hal::Result<pipeline::ConfigDocument>& document) {
  if (!document)
    return tl::make_unexpected(document.error());
  ConfigTable root = document->root();
  ControlModel model;
  model.model = "learned";
  read_usb(root, model);
  model.name = root.text("name", "learned control");
  if (root.has("report_id"))
    model.report_id = static_cast<std::uint8_t>(root.integer("report_id", 0, {0, 255}));
  std::vector<ConfigTable> switches = root.tables("switch");
  if (switches.empty() || switches.size() > hal::linux_backend::most_switches)
    root.complain("{} switches, expected 1 to {}", switches.size(),
                  hal::linux_backend::most_switches);
  for (ConfigTable& entry : switches)
    read_switch(entry, model);
  if (!model.keys.empty() && !model.bits.empty())
    root.complain("some switches are keys and some are bits, expected them of one kind");
  HAL_CHECK(document->finish());
  model.family = model.keys.empty() ? HidFamily::mapped : HidFamily::keyboard;
  model.switches = static_cast<int>(switches.size());
  return model;
}

// A TOML string: names come from the device, which may call itself anything.
std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += '\\';
    if (c >= ' ' && c <= '~') // what is not ASCII would have to be valid UTF-8
      out += c;
  }
  return out + "\"";
}

} // namespace

hal::Result<ControlModel> load_control_device(const std::filesystem::path& file) {
  return read(pipeline::ConfigDocument::load(file));
}

hal::Result<ControlModel> parse_control_device(std::string_view text,
                                               const std::filesystem::path& name) {
  return read(pipeline::ConfigDocument::parse(text, name));
}

std::vector<ControlModel> control_models(const std::optional<std::filesystem::path>& learned) {
  std::vector<ControlModel> models;
  if (learned)
    if (auto model = load_control_device(*learned)) // the configuration has complained otherwise
      models.push_back(std::move(*model));
  for (const ControlModel& model : hal::linux_backend::listed_control_models())
    models.push_back(model);
  return models;
}

std::string control_device_text(const ControlModel& model) {
  std::string text =
      fmt::format("# Learned by `octascope devices --learn`.\nusb = \"{}\"\n"
                  "name = {}\n",
                  hal::linux_backend::usb_id(model.vendor, model.product), in_quotes(model.name));
  if (model.report_id)
    text += fmt::format("report_id = {}\n", *model.report_id);
  for (const std::uint16_t key : model.keys)
    text += fmt::format("\n[[switch]]\nkey = {}\n", key);
  for (const auto& bit : model.bits)
    text += fmt::format("\n[[switch]]\nbyte = {}\nmask = {}\n", bit.byte, bit.mask);
  return text;
}

std::string first_profile_text(const ControlModel& model) {
  const auto bind = [](int index, std::string_view gesture, std::string_view action) {
    return fmt::format("\n[[bind]]\nswitch = {}\ngesture = \"{}\"\naction = \"{}\"\n", index,
                       gesture, action);
  };
  std::string names;
  for (int i = 0; i < model.switches; ++i)
    names += fmt::format("{}\"{}\"", i > 0 ? ", " : "", i + 1);
  const int last = model.switches - 1;
  return fmt::format("# To begin with; every action: ui/view/action.h.\nname = {}\n\n[device]\n"
                     "usb = [\"{}\"]\nswitches = [{}]\nswitch_word = \"switch\"\nknobs = []\n",
                     in_quotes(model.name), hal::linux_backend::usb_id(model.vendor, model.product),
                     names) +
         bind(0, "press", "freeze") + bind(last, last > 0 ? "press" : "double", "next_parameter") +
         bind(last, "long", "adjust");
}

} // namespace octascope::firmware_host
