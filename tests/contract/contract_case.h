// What the suites of all contracts share.
#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "hal/result.h"

namespace octascope::tests {

// What a suite is run against: a device's bench, or a clock.
template <class Bench> struct ContractCase {
  std::string name;
  std::function<std::unique_ptr<Bench>()> make;

  friend void PrintTo(const ContractCase& c, std::ostream* out) { *out << c.name; }
};

// Names the instances of a suite after their cases.
struct NameOfCase {
  template <class Case> std::string operator()(const testing::TestParamInfo<Case>& info) const {
    return info.param.name;
  }
};

template <class R> void expect_fault(const R& result, hal::ErrorCode fault) {
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, fault) << result.error().message;
  EXPECT_GT(result.error().message.size(), 20U) << "a message says what to do";
}

} // namespace octascope::tests
