// The vessel tree in the B-scans, the en-face and the microscope's picture.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/result.h"
#include "ui/layout/layout.h"
#include "ui/vessels/sections/picture_place.h"
#include "ui/vessels/sections/section_painter.h"
#include "ui/vessels/sections/vessel_sections.h"

namespace octascope::ui {

enum class VesselPanel : std::uint8_t { b_scan, crossed, en_face, microscope };

// Each picture is kept until what it is made of changes.
//
// Threads: as gl/objects.h. Allocates when a tree is shown and, in GL, when a picture's size
// changes.
class FlatVessels {
public:
  // ErrorCode::unsupported: this GL cannot compile the shaders.
  static hal::Result<FlatVessels> create();

  // The tree is borrowed until the next show(). Without a registration nothing is drawn.
  void show(const PlacedVessels& vessels);

  // Makes what is to be laid over the panel's picture, which is laid out as `place` says. `unit`:
  // Layout::unit. Errors as SectionPainter::draw().
  hal::Result<> prepare(VesselPanel panel, const VesselSections::Sight& sight,
                        const PicturePlace& place, float unit);
  // Counts what prepare() has made anew for the panel; from 1.
  std::uint64_t version(VesselPanel panel) const;
  // Draws it over the panel's picture, which fills `rect` of the bound framebuffer.
  void draw(VesselPanel panel, const Rect& rect, int target_height) const;

  // Whether the thinnest vessels were left out of a picture that the last prepare() of it made.
  bool left_out() const;

  // The pictures made so far: unchanged ones are not made again.
  std::uint64_t drawings() const { return drawings_; }

private:
  explicit FlatVessels(SectionPainter painter);

  struct Key {
    std::uint64_t marks;
    PicturePlace place;
    SectionPainter::Style style;
    bool operator==(const Key&) const = default;
  };
  struct KeptPicture {
    SectionLayer layer{};
    std::optional<Key> key{};
    Rect covered{}; // of the layer, in its pixels
    std::uint64_t version = 0;
  };

  VesselSections sections_;
  SectionPainter painter_;
  std::array<KeptPicture, 4> pictures_;
  std::vector<PlacedMark> placed_;
  std::uint64_t drawings_ = 0;
};

} // namespace octascope::ui
