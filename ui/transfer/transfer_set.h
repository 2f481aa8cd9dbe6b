// The available transfer functions and colour maps.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.h"
#include "ui/transfer/colour_map.h"
#include "ui/transfer/transfer_curve.h"
#include "ui/transfer/transfer_table.h"
#include "ui/view/choice_value.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// A level's appearance depends on its position u in the display window, so that the window's two
// knobs control every transfer function: u = clamp((level − offset) / size, 0, 1).
struct TransferFunction {
  std::string name;
  TransferCurve curve;              // opacity over one reference step, times ViewState::opacity
  std::optional<ColourMap> colours; // empty: grey
};

// Immutable. Copies share their contents, so they are cheap and may go to any thread.
class TransferSet {
public:
  // The built-in ones. Functions: "window", formula (1) of the OCT paper; "smooth", clear but for
  // what reflects strongly; "surface", opaque from where tissue begins, in lifted greys. Colour maps:
  // "grey", "amber", "blue-green", "dawn", "depth".
  TransferSet();

  // Adds functions after the existing ones. ErrorCode::invalid_argument: a name already exists.
  hal::Result<TransferSet> with(std::vector<TransferFunction> functions) const;

  // In the order of ViewState::transfer and ViewState::colour_map.
  std::span<const TransferFunction> functions() const { return contents_->functions; }
  std::span<const ColourMap> colour_maps() const { return contents_->colour_maps; }
  ChoiceNames names() const;
  std::optional<int> function_named(std::string_view name) const;
  std::optional<int> colour_map_named(std::string_view name) const;

  // The function that the view selects, or the first if its index does not exist. If the function
  // has its own colours, the first colour map selects them.
  const TransferFunction& function(const ViewState& view) const;
  const ColourMap& colours(const ViewState& view) const;

private:
  struct Contents {
    std::vector<TransferFunction> functions;
    std::vector<ColourMap> colour_maps;
  };
  explicit TransferSet(Contents contents);

  std::shared_ptr<const Contents> contents_;
};

// Samples the view's selection; colours by depth are spread over the whole of it. Allocates nothing;
// takes some ten microseconds.
void make_transfer_table(const ViewState& view, const TransferSet& set, TransferTable& table);

} // namespace octascope::ui
