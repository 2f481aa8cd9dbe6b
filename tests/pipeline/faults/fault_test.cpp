#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "pipeline/faults/fault.h"

namespace octascope::pipeline {
namespace {

TEST(Fault, is_told_apart_from_every_other_by_its_keys) {
  std::set<std::pair<std::string_view, std::string_view>> keys;
  for (std::size_t i = 0; i < fault_count; ++i) {
    const FaultFacts facts = facts_of(static_cast<Fault>(i));
    EXPECT_EQ(index_of(facts.fault), i);
    EXPECT_FALSE(facts.key.empty()) << i;
    EXPECT_TRUE(keys.emplace(facts.device_key(), facts.key).second)
        << facts.device_key() << " " << facts.key;
  }
}

TEST(Fault, each_code_of_each_device_is_one) {
  EXPECT_EQ(to_string(static_cast<hal::ErrorCode>(error_code_count)), "unknown fault") << "counted";
  for (std::size_t d = 0; d < device_count; ++d)
    for (std::size_t c = 0; c < error_code_count; ++c) {
      const auto device = static_cast<Device>(d);
      const auto code = static_cast<hal::ErrorCode>(c);
      EXPECT_EQ(facts_of(fault_of(device, code)).device, device);
      EXPECT_EQ(facts_of(fault_of(device, code)).key, to_string(code));
    }
}

} // namespace
} // namespace octascope::pipeline
