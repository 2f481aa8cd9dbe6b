// A manager of seats whose strings the test pulls: stands in the place of libseat's functions (the
// program's own definitions come before the library's) and does with the real card what seatd does.
#pragma once

#include <optional>
#include <string>

namespace octascope::tests {

struct FakeSeat {
  bool answers = true;      // false: there is no manager
  bool in_front = true;     // is our console the one that is seen?
  bool acknowledged = true; // we have let go of the devices since it is not
  int opened = 0;           // devices that are open
  int seats = 0;            // that are open

  // As Ctrl-Alt-F2 and Ctrl-Alt-F1 do; heard at the next libseat_dispatch().
  void switch_away();
  void switch_back();
};

// libseat has one function a call and no place for a test's object: this is the process's.
FakeSeat& fake_seat();

} // namespace octascope::tests
