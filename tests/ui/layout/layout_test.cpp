// Layouts of all kinds at the sizes of displays and at random ones.
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/files/fresh_seed.h"
#include "ui/layout/layout.h"

namespace octascope::ui {
namespace {

constexpr std::array kinds{LayoutKind::volume, LayoutKind::b_scan, LayoutKind::microscope,
                           LayoutKind::quad};

struct Case {
  int width;
  int height;
  PictureAspects aspects;
  LayoutKind kind;

  Layout layout() const { return lay_out(width, height, aspects, kind); }
  std::string words() const {
    return fmt::format("{}x{}, kind {}, aspects {} {} {}{}", width, height, static_cast<int>(kind),
                       aspects.b_scan, aspects.en_face, aspects.scope,
                       aspects.has_scope ? "" : ", no scope");
  }
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto& [w, h] : {std::pair{1920, 1080},
                             {1280, 720},
                             {3840, 2160},
                             {1024, 768},
                             {1600, 1200},
                             {1280, 1024},
                             {640, 360},
                             {7680, 4320},
                             {14000, 8000},
                             {16384, 16384},
                             {720, 1280},
                             {1080, 1920}})
    for (const LayoutKind kind : kinds)
      for (const bool has_scope : {true, false})
        for (const double scope : {4.0 / 3, 16.0 / 9})
          all.push_back({w, h, {1.67, 1, scope, has_scope, 1.67}, kind});
  std::mt19937 random{tests::fresh_seed()};
  std::uniform_int_distribution<int> length{320, 4096};
  std::uniform_real_distribution<double> aspect{-1, 1};
  const auto any = [&] { return std::exp2(1.5 * aspect(random)); };
  for (int i = 0; i < 4000; ++i) {
    const int width = length(random);
    const int height = std::clamp(length(random), width / 3, width * 3);
    all.push_back({width,
                   height,
                   {any(), any(), any(), i % 3 != 0, any()},
                   kinds[static_cast<std::size_t>(i) % kinds.size()]});
  }
  return all;
}

bool within(const Rect& inner, const Rect& outer) {
  return inner.x >= outer.x && inner.y >= outer.y && inner.right() <= outer.right() &&
         inner.bottom() <= outer.bottom();
}

bool overlap(const Rect& a, const Rect& b) {
  return !a.empty() && !b.empty() && a.x < b.right() && b.x < a.right() && a.y < b.bottom() &&
         b.y < a.bottom();
}

Rect middle_of(const Rect& rect) {
  // Rounded inwards: a quarter of an odd length ends within a pixel.
  return {rect.x + (rect.width + 3) / 4, rect.y + (rect.height + 3) / 4, rect.width / 2 - 1,
          rect.height / 2 - 1};
}

TEST(Layout, nothing_overlaps_and_everything_is_inside) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.words());
    const Layout l = c.layout();
    const Rect screen{0, 0, c.width, c.height};
    std::vector<Rect> plates{l.status_bar, l.view_frame.empty() ? l.view : l.view_frame};
    for (const Panel* panel : {&l.b_scan, &l.crossed, &l.en_face, &l.scope})
      if (panel->shown()) {
        ASSERT_TRUE(within(panel->picture, panel->frame));
        ASSERT_TRUE(within(panel->title, panel->frame));
        ASSERT_FALSE(overlap(panel->picture, panel->title));
        plates.push_back(panel->frame);
      }
    if (!l.view_frame.empty()) {
      ASSERT_TRUE(within(l.view, l.view_frame));
      ASSERT_FALSE(overlap(l.view, l.view_title));
    }
    ASSERT_FALSE(l.view.empty());
    for (std::size_t i = 0; i < plates.size(); ++i) {
      ASSERT_TRUE(within(plates[i], screen)) << i;
      for (std::size_t k = i + 1; k < plates.size(); ++k) {
        ASSERT_FALSE(overlap(plates[i], plates[k])) << i << " and " << k;
      }
    }
    for (const Rect& plate : plates)
      ASSERT_TRUE(l.kind == LayoutKind::volume || !overlap(l.marks, plate));
  }
}

// However small or long: letters of some size, and a place for the volume.
TEST(Layout, of_every_size_has_letters_and_a_volume) {
  for (const LayoutKind kind : kinds)
    for (int width = 1; width <= 16384; width += width < 40 ? 1 : width / 9)
      for (int height = 1; height <= 16384; height += height < 40 ? 1 : height / 9) {
        const Layout l = lay_out(width, height, {}, kind);
        ASSERT_GT(l.unit, 0) << width << "x" << height;
        ASSERT_LE(l.unit, largest_unit) << width << "x" << height;
        ASSERT_FALSE(l.view.empty()) << width << "x" << height;
        ASSERT_FALSE(l.status_bar.empty()) << width << "x" << height;
      }
}

TEST(Layout, pictures_have_their_physical_aspect) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.words());
    const Layout l = c.layout();
    const auto expect_aspect = [](const Panel& panel, double aspect) {
      if (!panel.shown())
        return;
      // Each side is rounded to a pixel.
      const Rect& p = panel.picture;
      ASSERT_NEAR(p.width, p.height * aspect, 1 + 0.5 * aspect);
    };
    expect_aspect(l.b_scan, c.aspects.b_scan);
    expect_aspect(l.crossed, c.aspects.crossed);
    expect_aspect(l.en_face, c.aspects.en_face);
    expect_aspect(l.scope, c.aspects.scope);
  }
}

TEST(Layout, what_lies_over_the_large_picture_leaves_its_middle_free) {
  for (const Case& c : cases())
    for (const Extras& extras : {Extras{},
                                 {.figures = true},
                                 {.legend = true},
                                 {true, true},
                                 {true, false, true},
                                 {true, true, true}}) {
      SCOPED_TRACE(c.words());
      const Layout l = lay_out(c.width, c.height, c.aspects, c.kind, extras);
      const Rect middle = middle_of(l.large);
      const Rect screen{0, 0, c.width, c.height};
      for (const Rect* over :
           {&l.marks, &l.notice, &l.legend, &l.histogram, &l.figures, &l.timing}) {
        ASSERT_TRUE(over->empty() || within(*over, screen));
        ASSERT_FALSE(overlap(*over, middle))
            << over->x << " " << over->y << " " << over->width << " " << over->height;
      }
      ASSERT_TRUE(within(l.notice, l.status_bar));
      ASSERT_TRUE(within(l.histogram, l.large));
      ASSERT_FALSE(overlap(l.figures, l.status_bar));
      ASSERT_FALSE(overlap(l.timing, l.figures));
      ASSERT_EQ(l.figures.empty(), !extras.figures);
      ASSERT_EQ(l.timing.empty(), !extras.timing);
      ASSERT_EQ(l.legend.empty(), !extras.legend);
      for (const Rect* beside : {&l.histogram, &l.status_bar, &l.figures, &l.timing, &l.marks,
                                 &l.view, &l.b_scan.frame, &l.en_face.frame, &l.scope.frame})
        ASSERT_FALSE(overlap(l.legend, *beside)) << "no picture is under the legend";
      ASSERT_TRUE(l.cube.empty() || within(l.cube, l.view));
      ASSERT_FALSE(overlap(l.cube, l.marks));
    }
}

// Each, of whatever aspect, fills its frame one way or the other.
TEST(Layout, small_pictures_use_the_screen) {
  for (const auto& [w, h] : {std::pair{1920, 1080}, {1280, 720}, {3840, 2160}, {1024, 768}})
    for (const LayoutKind kind : kinds) {
      const Layout l = lay_out(w, h, {1.67, 1, 4.0 / 3}, kind);
      for (const Panel* panel : {&l.b_scan, &l.en_face, &l.scope}) {
        ASSERT_TRUE(panel->shown()) << w << "x" << h << ", kind " << static_cast<int>(kind);
        // Smallest beside a large B-scan, which takes what it can, and under two B-scans.
        const bool smallest =
            kind == LayoutKind::b_scan || (kind == LayoutKind::volume && panel == &l.scope);
        EXPECT_GE(panel->picture.width, w / (smallest ? 9 : 8))
            << w << "x" << h << ", " << static_cast<int>(kind);
        const Rect& frame = panel->frame; // with a title and a border
        EXPECT_TRUE(panel->picture.width >= frame.width * 9 / 10 ||
                    panel->picture.height + panel->title.height >= frame.height * 9 / 10);
      }
      EXPECT_FALSE(l.view.empty());
    }
}

TEST(Layout, the_large_picture_is_the_largest) {
  const auto area = [](const Rect& rect) { return static_cast<double>(rect.width) * rect.height; };
  for (const auto& [w, h] : {std::pair{1920, 1080}, {1280, 720}, {3840, 2160}, {1024, 768}})
    for (const LayoutKind kind : {LayoutKind::volume, LayoutKind::b_scan, LayoutKind::microscope}) {
      const Layout l = lay_out(w, h, {1.67, 1, 4.0 / 3}, kind);
      EXPECT_EQ(l.kind, kind);
      EXPECT_EQ(l.large, kind == LayoutKind::volume   ? l.view
                         : kind == LayoutKind::b_scan ? l.b_scan.picture
                                                      : l.scope.picture);
      const double crossed = kind == LayoutKind::b_scan ? area(l.crossed.picture) : 0;
      EXPECT_GT(area(l.large) + crossed, 0.35 * w * h);
      for (const Rect& other : {l.crossed.picture, l.en_face.picture, l.scope.picture, l.view})
        EXPECT_GE(area(l.large), area(other));
    }
}

TEST(Layout, four_alike_are_alike) {
  const Layout l = lay_out(1920, 1080, {1.67, 1, 4.0 / 3}, LayoutKind::quad);
  ASSERT_TRUE(l.crossed.shown());
  // The crossed B-scan shares the cell of one of them.
  const bool with_b_scan = l.crossed.frame.y == l.b_scan.frame.y;
  const auto both = [&](const Rect& frame) {
    return Rect{frame.x, frame.y, l.crossed.frame.right() - frame.x, frame.height};
  };
  for (const Rect& cell : {with_b_scan ? both(l.b_scan.frame) : l.b_scan.frame,
                           with_b_scan ? l.en_face.frame : both(l.en_face.frame), l.scope.frame}) {
    EXPECT_NEAR(cell.width, l.view_frame.width, 1);
    EXPECT_NEAR(cell.height, l.view_frame.height, 1);
  }
}

TEST(Layout, both_crossed_b_scans_are_large_where_one_is) {
  const auto area = [](const Rect& rect) { return static_cast<double>(rect.width) * rect.height; };
  for (const auto& [w, h] : {std::pair{1920, 1080}, {1280, 720}, {3840, 2160}, {1024, 768}})
    for (const double aspect : {1.0, 1.67, 2.5, 4.0}) {
      SCOPED_TRACE(fmt::format("{}x{}, {}", w, h, aspect));
      const PictureAspects aspects{aspect, 1, 4.0 / 3, true, aspect};
      const Layout l = lay_out(w, h, aspects, LayoutKind::b_scan);
      ASSERT_TRUE(l.crossed.shown());
      for (const Rect& other : {l.view, l.en_face.picture, l.scope.picture})
        EXPECT_GT(area(l.crossed.picture), (w == 1024 ? 0.4 : 0.75) * area(other)); // below at 4:3
      EXPECT_TRUE(w == 1024 || lay_out(w, h, aspects, LayoutKind::quad).crossed.shown());
    }
}

// Beside a large volume, too: neither a strip, and the volume no narrower for it.
TEST(Layout, both_crossed_b_scans_are_beside_the_volume) {
  const auto area = [](const Rect& rect) { return static_cast<double>(rect.width) * rect.height; };
  for (const auto& [w, h] : {std::pair{1920, 1080}, {1280, 720}, {3840, 2160}, {1024, 768}})
    for (const double aspect : {1.0, 1.3, 1.67, 2.2, 3.0})
      for (const bool has_scope : {true, false}) {
        SCOPED_TRACE(fmt::format("{}x{}, {}, {}", w, h, aspect, has_scope));
        const PictureAspects aspects{aspect, 1, 4.0 / 3, has_scope, aspect};
        const Layout l = lay_out(w, h, aspects, LayoutKind::volume);
        ASSERT_TRUE(l.crossed.shown());
        EXPECT_GT(area(l.b_scan.picture), 0.045 * w * h);
        EXPECT_GT(area(l.crossed.picture), area(l.b_scan.picture) / 5);
        EXPECT_GE(l.en_face.picture.width, w / 8);
        EXPECT_GE(l.view.width, w * 55 / 100);
      }
}

TEST(Layout, the_large_b_scan_has_a_third_of_the_screen) {
  for (const auto& [w, h] : {std::pair{1920, 1080}, {1280, 720}, {3840, 2160}, {1024, 768}}) {
    const Layout l = lay_out(w, h, {1.67, 1, 4.0 / 3, true, 1.67}, LayoutKind::b_scan);
    EXPECT_GT(static_cast<double>(l.large.width) * l.large.height, 0.33 * w * h);
  }
}

TEST(Layout, without_a_microscope_its_room_is_shared) {
  const PictureAspects with{1.67, 1, 4.0 / 3, true};
  PictureAspects without = with;
  without.has_scope = false;
  for (const LayoutKind kind : kinds) {
    const Layout l = lay_out(1280, 720, without, kind);
    EXPECT_FALSE(l.scope.shown());
    EXPECT_TRUE(l.en_face.shown());
    EXPECT_TRUE(l.b_scan.shown());
    EXPECT_NE(l.kind, LayoutKind::microscope);
    const auto room = [&](const PictureAspects& aspects) { // of the small pictures of the scan
      const Layout each = lay_out(1280, 720, aspects, kind);
      const auto area = [](const Panel& panel) {
        return static_cast<double>(panel.frame.width) * panel.frame.height;
      };
      return area(each.en_face) +
             (kind == LayoutKind::volume ? area(each.b_scan) + area(each.crossed) : 0);
    };
    EXPECT_TRUE(kind == LayoutKind::microscope || kind == LayoutKind::quad ||
                room(without) > (kind == LayoutKind::volume ? 1.15 : 1.3) * room(with));
  }
}

TEST(Layout, a_wide_microscope_picture_keeps_all_others_beside_it) {
  for (const double aspect : {4.0 / 3, 16.0 / 9, 2.1})
    for (const auto& [w, h] : {std::pair{1920, 1080}, {1024, 768}}) {
      const Layout l = lay_out(w, h, {1.67, 1, aspect}, LayoutKind::microscope);
      EXPECT_TRUE(l.b_scan.shown());
      EXPECT_TRUE(l.en_face.shown());
      EXPECT_GE(l.view.width, w / 10);
      EXPECT_GE(l.scope.picture.width, w / 2);
    }
}

} // namespace
} // namespace octascope::ui
