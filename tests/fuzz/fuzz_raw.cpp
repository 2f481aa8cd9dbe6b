// A recording of raw spectra, changed anywhere or cut off: read within its bounds, or a message. All
// its checksums of HDF5 are the same number (--wrap), so that what is changed gets as far as decoders.
//
// The input: how much of the file is there (two bytes; 0: all of it), then bytes to change, three
// each: the place, the value.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "pipeline/recordings/raw/raw_reader.h"
#include "tests/fuzz/expect.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/small_raw.h"

extern "C" std::uint32_t __wrap_H5_checksum_metadata(const void*, std::size_t, std::uint32_t) {
  return 0x6f637461;
}

namespace {

using namespace octascope;

std::string good_file() {
  const tests::ScratchFolder folder;
  tests::write_small_raw(folder / "good.h5", 12);
  return tests::whole_file(folder / "good.h5");
}

std::size_t number_at(std::span<const std::uint8_t> bytes) {
  return bytes[0] + std::size_t{256} * bytes[1];
}

// As a file in memory, which has a name.
void write_changed(const std::string& name, std::span<const std::uint8_t> changes) {
  static const std::string good = good_file();
  std::string bytes = good;
  if (const std::size_t length = changes.size() < 2 ? 0 : number_at(changes); length > 0)
    bytes.resize(std::min(length, bytes.size()));
  for (changes = changes.subspan(std::min<std::size_t>(2, changes.size())); changes.size() >= 3;
       changes = changes.subspan(3))
    bytes[number_at(changes) % bytes.size()] = static_cast<char>(changes[2]);
  std::FILE* const file = std::fopen(name.c_str(), "wb");
  tests::expect(file != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size(),
                "the file takes them");
  std::fclose(file);
}

void check(const pipeline::RawReader& reader, const std::string& name) {
  const pipeline::RawFacts& facts = reader.facts();
  tests::expect(reader.frames().size() * facts.format.frame_bytes() <=
                    std::filesystem::file_size(name),
                "the file has room for all frames");
  std::size_t frames = 0;
  for (const pipeline::RawVolume& volume : reader.volumes()) {
    tests::expect(volume.first == frames, "one volume comes after the other");
    frames += volume.count;
    tests::expect(!volume.whole || volume.count == static_cast<std::size_t>(facts.plan.sweeps()),
                  "what is whole has all its sweeps");
  }
  tests::expect(frames == reader.frames().size(), "each frame is of a volume");
  if (const auto backgrounds = reader.backgrounds(0, frames))
    tests::expect(std::ranges::all_of(*backgrounds, [](float v) { return std::isfinite(v); }),
                  "backgrounds are numbers");
  const auto spectra = reader.spectra(0, frames, pipeline::RawLines::all);
  if (!spectra)
    return;
  tests::expect(spectra->shape().b_scans == static_cast<int>(frames), "all are there");
  for (int b = 0; b < spectra->shape().b_scans; ++b) {
    static_cast<void>(spectra->find_fault(b));
    tests::expect(spectra->b_scan(b).size() == facts.format.frame_bytes(), "as large as it says");
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const int file = ::memfd_create("raw", MFD_CLOEXEC);
  static const std::string name = fmt::format("/proc/self/fd/{}", file);
  write_changed(name, {bytes, size});
  if (const auto reader = pipeline::RawReader::open(name))
    check(*reader, name);
  else
    tests::expect(reader.error().message.starts_with(name + ": ") &&
                      reader.error().message.find('\n') == std::string::npos,
                  reader.error().message);
  return 0;
}
