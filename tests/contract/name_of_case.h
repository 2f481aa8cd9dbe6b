// Names the instances of a contract suite after their cases.
#pragma once

#include <string>

#include <gtest/gtest.h>

namespace octascope::tests {

struct NameOfCase {
  template <class Case> std::string operator()(const testing::TestParamInfo<Case>& info) const {
    return info.param.name;
  }
};

} // namespace octascope::tests
