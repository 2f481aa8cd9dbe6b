// The selectable values, in the order of each enumeration.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace octascope::ui {

struct ChoiceValue {
  std::string_view name;  // on the command line, in settings and reports
  std::string_view words; // on the display
};

inline constexpr std::array technique_values{ChoiceValue{"slices", "slices"},
                                             ChoiceValue{"planes", "planes"},
                                             ChoiceValue{"rays", "rays"},
                                             ChoiceValue{"shaded", "shaded rays"},
                                             ChoiceValue{"maximum", "maximum intensity"},
                                             ChoiceValue{"surface", "surface"}};
inline constexpr std::array layout_values{
    ChoiceValue{"volume", "volume"}, ChoiceValue{"b_scan", "B-scan"},
    ChoiceValue{"microscope", "microscope"}, ChoiceValue{"quad", "quad"}};
inline constexpr std::array stereo_values{ChoiceValue{"off", "off"},
                                          ChoiceValue{"side_by_side", "side by side"},
                                          ChoiceValue{"top_bottom", "top and bottom"}};
inline constexpr std::array cut_values{ChoiceValue{"off", "off"},
                                       ChoiceValue{"b_scan", "at the B-scan"},
                                       ChoiceValue{"corner", "at both B-scans"}};
inline constexpr std::array figures_values{ChoiceValue{"hidden", "hidden"},
                                           ChoiceValue{"strip", "shown"},
                                           ChoiceValue{"timing", "with timing"}};
inline constexpr std::array vessels_shown_values{
    ChoiceValue{"off", "hidden"}, ChoiceValue{"flow", "flow"}, ChoiceValue{"tree", "tree"},
    ChoiceValue{"both", "flow and tree"}};
inline constexpr std::array vessel_colouring_values{ChoiceValue{"branch", "main branches"},
                                                    ChoiceValue{"order", "orders"},
                                                    ChoiceValue{"diagnostic", "who drew them"}};

// The names of choices that the configuration can add to; never empty.
struct ChoiceNames {
  std::vector<std::string> transfers{"window"};
  std::vector<std::string> colours{"grey"};
};

} // namespace octascope::ui
