// A graphics driver whose processor the test resets: no driver on the bench has one, and none tells
// of resets. Stands in the place of those functions of EGL and GLES that ask for it (the program's
// own definitions come before the libraries'), and leads to the real ones for everything else.
#pragma once

#include <vector>

namespace octascope::tests {

struct FakeDriver {
  bool tells_of_resets = false;        // false: nothing is as if it were not there
  unsigned status = 0;                 // what glGetGraphicsResetStatus says
  int asked = 0;                       // how often
  int first_reset = 0, last_reset = 0; // of these times, without a status; 0: none
  bool refuses = false;                // contexts that tell of resets
  std::vector<int> context_attributes; // of the context that was made last
};

// EGL has no place for a test's object: this is the process's. Loaded into a program of which it is
// no part (LD_PRELOAD), OCTASCOPE_FAKE_RESET="25 3" makes it tell of resets: after 25 times that
// it was asked, three times.
FakeDriver& fake_driver();

} // namespace octascope::tests
