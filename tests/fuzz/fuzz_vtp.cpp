// VTP: a tree that keeps its promises, or a message.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "pipeline/vessels/files/vtp_reader.h"
#include "tests/fuzz/tree_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace octascope;
  const auto read = pipeline::parse_vtp({reinterpret_cast<const char*>(bytes), size}, "name");
  if (read)
    tests::expect_tree(read->tree);
  else
    tests::expect_refusal(read.error().message);
  return 0;
}
