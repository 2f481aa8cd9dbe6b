// Calibrations, their curves as text and as floats, and raw spectra: what may be used, or a message
// that names the file. The first byte says as what the rest is read.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "pipeline/calibration/calibration.h"
#include "pipeline/reconstruction/spectra_file.h"
#include "tests/fuzz/expect.h"
#include "tests/support/files/scratch_folder.h"

namespace {

using namespace octascope;

constexpr int samples = 16;

void expect_message(const hal::Error& error, const tests::ScratchFolder& folder) {
  tests::expect(error.message.find(folder.path().string()) != std::string::npos, error.message);
}

void read_calibration(const tests::ScratchFolder& folder, std::string_view toml) {
  const auto read = pipeline::Calibration::load(folder.write("c.toml", toml), samples);
  if (!read)
    return expect_message(read.error(), folder);
  tests::expect(read->validate().has_value(), "what was read may be used");
  static_cast<void>(pipeline::doubt_about_k_table(*read, "c.toml"));
}

void read_curve(const tests::ScratchFolder& folder, std::string_view curve,
                std::string_view gives) {
  folder.write("k.txt", curve);
  read_calibration(folder, "[spectrometer]\nsamples = 16\n[k_linear]\ntable = \"k.txt\"\n" +
                               std::string{gives});
}

void read_spectra(const tests::ScratchFolder& folder, std::string_view bytes) {
  const std::size_t end = bytes.find('\n');
  const auto shape = pipeline::SpectraShape::parse(bytes.substr(0, end));
  if (!shape || end == std::string_view::npos)
    return;
  const auto file = folder.write("s.raw", bytes.substr(end + 1));
  for (const auto type : {hal::SampleType::u8, hal::SampleType::u16, hal::SampleType::f32}) {
    const auto spectra = pipeline::SpectraFile::open(file, *shape, type);
    if (!spectra) {
      expect_message(spectra.error(), folder);
      continue;
    }
    const pipeline::SpectrumFormat format{shape->samples, type};
    for (int b = 0; b < shape->b_scans; ++b) {
      static_cast<void>(spectra->find_non_finite(b));
      static_cast<void>(spectra->find_above_full_scale(b, format));
    }
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const tests::ScratchFolder folder;
  if (size == 0)
    return 0;
  const std::string_view rest{reinterpret_cast<const char*>(bytes) + 1, size - 1};
  switch (bytes[0] % 5) {
  case 0: read_calibration(folder, rest); break;
  case 1: read_curve(folder, rest, ""); break;
  case 2: read_curve(folder, rest, "table_gives = \"wavenumber\"\n"); break;
  case 3:
    folder.write("b.raw", rest);
    read_calibration(folder, "[spectrometer]\nsamples = 16\n[k_linear]\npolynomial = [0, 15]\n"
                             "[background]\nmode = \"file\"\nfile = \"b.raw\"\n");
    break;
  default: read_spectra(folder, rest); break;
  }
  return 0;
}
