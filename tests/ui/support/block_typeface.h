// A typeface for golden pictures, so that they do not depend on the version of the display's own.
//
// Every letter is as wide as every other and shows its number as a pattern of blocks: pictures of
// different words differ, and all programs that set text in it set it alike. That Inter's letters
// are large enough and find room is tested with Inter (hud_marks_test.cpp, legend_test.cpp).
#pragma once

#include "ui/canvas/fonts.h"

namespace octascope::tests {

// For all letters that ui::Fonts asks for. The files live as long as the program.
ui::Typeface block_typeface();

} // namespace octascope::tests
