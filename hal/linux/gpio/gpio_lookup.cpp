#include "hal/linux/gpio/gpio_lookup.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "hal/linux/system/system_error.h"
#include "hal/linux/system/system_files.h"
#include "hal/number_text.h"

namespace octascope::hal::linux_backend {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view prefix = "gpiochip";

std::string file_name(const std::string& node) {
  return fs::path{node}.filename().string();
}

// "gpiochip0:17".
struct ChipAndOffset {
  std::string_view chip;
  unsigned offset;
};
std::optional<ChipAndOffset> chip_and_offset(std::string_view wanted) {
  const std::size_t colon = wanted.find(':');
  if (!wanted.starts_with(prefix) || colon == std::string_view::npos)
    return std::nullopt;
  const auto offset = number_of<unsigned>(wanted.substr(colon + 1));
  if (!number_of<unsigned>(wanted.substr(prefix.size(), colon - prefix.size())) || !offset)
    return std::nullopt;
  return ChipAndOffset{wanted.substr(0, colon), *offset};
}

std::string listed_chips(const GpioSurvey& survey) {
  std::string list;
  for (const GpioChipInfo& chip : survey.chips)
    list += fmt::format("{}{} ({}, {} lines)", list.empty() ? "" : ", ", file_name(chip.node),
                        chip.label, chip.lines.size());
  return list.empty() ? "no GPIO chip" : list;
}

tl::unexpected<Error> missing(const GpioSurvey& survey, std::string_view wanted) {
  if (!survey.complaints.empty())
    return fail(survey.udev_at_work ? ErrorCode::absent : ErrorCode::denied,
                "GPIO line \"{}\": found {}, but not every chip could be asked: {}", wanted,
                listed_chips(survey), survey.complaints.front());
  return fail(ErrorCode::absent,
              "GPIO line \"{}\": found {}, expected one with a line of that name; name the line in "
              "the device tree (gpio-line-names), or give it in the configuration as "
              "\"gpiochip0:17\"; `octascope devices` lists lines",
              wanted, listed_chips(survey));
}

Result<GpioLineAddress> by_offset(const GpioSurvey& survey, std::string_view wanted,
                                  const ChipAndOffset& place) {
  for (const GpioChipInfo& chip : survey.chips) {
    if (file_name(chip.node) != place.chip)
      continue;
    if (place.offset < chip.lines.size())
      return GpioLineAddress{chip.node, place.offset};
    return fail(ErrorCode::invalid_argument,
                "GPIO line \"{}\": offset {} found, expected 0 to {}, the lines of {}", wanted,
                place.offset, chip.lines.size() - 1, chip.node);
  }
  return missing(survey, wanted);
}

} // namespace

GpioSurvey survey_gpio(const fs::path& dev) {
  const std::vector<std::string> nodes = numbered_entries(dev, prefix);
  GpioSurvey survey;
  survey.udev_at_work = udev_is_at_work(); // before: it may be done at any moment
  for (const std::string& node : nodes) {
    if (auto chip = describe_gpio_chip(node))
      survey.chips.push_back(std::move(*chip));
    else if (chip.error().code == ErrorCode::denied && survey.udev_at_work)
      survey.complaints.push_back(fmt::format("{}: udev has not gone through it yet", node));
    else if (chip.error().code == ErrorCode::denied)
      survey.complaints.push_back(
          fmt::format("{}: permission denied; install the package, or its udev rule "
                      "(deploy/70-octascope.rules), "
                      "and join the group gpio (`sudo usermod -aG gpio $USER`, log in again)",
                      node));
    else if (chip.error().code != ErrorCode::absent) // it may go between listing and asking
      survey.complaints.push_back(chip.error().message);
  }
  return survey;
}

std::string listed_lines(const GpioChipInfo& chip) {
  std::string list;
  std::size_t nameless = 0;
  for (const GpioLineInfo& line : chip.lines) {
    if (line.name.empty())
      ++nameless;
    else
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", line.offset, line.name);
  }
  if (nameless > 0)
    list += fmt::format("{}{} without a name", list.empty() ? "" : ", ", nameless);
  return list;
}

Result<GpioLineAddress> find_gpio_line(const GpioSurvey& survey, std::string_view wanted) {
  if (wanted.empty())
    return fail(ErrorCode::invalid_argument,
                "GPIO line: its name is empty, expected a line's name or "
                "\"gpiochip0:17\"");
  if (const auto place = chip_and_offset(wanted))
    return by_offset(survey, wanted, *place);
  std::vector<GpioLineAddress> found;
  for (const GpioChipInfo& chip : survey.chips)
    for (const GpioLineInfo& line : chip.lines)
      if (line.name == wanted)
        found.push_back({chip.node, line.offset});
  if (found.empty())
    return missing(survey, wanted);
  if (found.size() > 1)
    return fail(ErrorCode::invalid_argument,
                "GPIO line \"{}\": {} lines have that name ({}:{} and {}:{}), expected one; give "
                "chip and offset",
                wanted, found.size(), file_name(found[0].node), found[0].offset,
                file_name(found[1].node), found[1].offset);
  return found.front();
}

std::string gpio_complaint(const GpioSurvey& survey, std::string_view wanted) {
  const auto address = find_gpio_line(survey, wanted);
  if (!address)
    return address.error().message;
  const auto chip = std::ranges::find(survey.chips, address->node, &GpioChipInfo::node);
  const GpioLineInfo& line = chip->lines[address->offset];
  if (!line.used)
    return {};
  return fmt::format("GPIO line \"{}\" ({}:{}): held by \"{}\", expected it free; end that program "
                     "or remove the driver's claim from the device tree",
                     wanted, file_name(address->node), line.offset,
                     line.consumer.empty() ? "somebody without a name" : line.consumer);
}

} // namespace octascope::hal::linux_backend
