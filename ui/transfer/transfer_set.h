// The transfer functions and colour maps to choose from.
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

// A level is looked up by its place u in the display window, so that the window's two knobs steer
// every transfer function: u = clamp((level − offset) / size, 0, 1).
struct TransferFunction {
  std::string name;
  TransferCurve curve;              // opacity over one reference step, times ViewState::opacity
  std::optional<ColourMap> colours; // its own; empty: grey
};

// Immutable; copies share their content, so they are cheap and may be used on any thread.
class TransferSet {
public:
  // The built-in ones. Functions: "window", the paper's formula (1); "smooth", a gentle S that
  // calms noise and keeps bright tissue apart; "surface", opaque where tissue begins and clearer
  // below. Colour maps: "grey", "amber", "blue-green", "dawn".
  TransferSet();

  // Adds these after the built-in ones. ErrorCode::invalid_argument: a name that exists already.
  hal::Result<TransferSet> with(std::vector<TransferFunction> functions) const;

  // In the order of ViewState::transfer and ViewState::colour_map.
  std::span<const TransferFunction> functions() const { return contents_->functions; }
  std::span<const ColourMap> colour_maps() const { return contents_->colour_maps; }
  ChoiceNames names() const;
  std::optional<int> function_named(std::string_view name) const;
  std::optional<int> colour_map_named(std::string_view name) const;

  // What the view has chosen; the first if there is no such index. The first colour map means the
  // function's own colours, if it has any.
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

// Samples what the view has chosen. Allocates nothing; takes some ten microseconds.
void make_transfer_table(const ViewState& view, const TransferSet& set, TransferTable& table);

} // namespace octascope::ui
