// octascope bench reconstruct: measures each reconstruction path on this machine relative to bare
// FFTW transforms interleaved on the same core, and checks the results.
#pragma once

#include <string>
#include <vector>

#include "hal/result.h"
#include "pipeline/reconstruction/reconstructor.h"

namespace octascope::firmware_host {

// Of a line.
inline constexpr int bench_samples = 1024;

// What is measured: 300 lines of 1024 u16 samples a B-scan, Hann window, a chirp of 70 pixels,
// 8-bit levels. The background is recorded; or runs, each thread with its own, where live one
// thread has it for all; or is the mean of the B-scan's lines: then they are read twice.
struct BenchCase {
  pipeline::ReconstructionPath path = pipeline::ReconstructionPath::fftw;
  std::string isa;
  pipeline::Interpolation interpolation = pipeline::Interpolation::sinc8;
  bool dispersion = true;
  pipeline::BackgroundMode background = pipeline::BackgroundMode::file;
  int threads = 1;
};

struct BenchResult {
  BenchCase what;
  double lines_per_s = 0;   // median
  double ratio_to_fftw = 0; // time per line / time per bare transform: median of the repeats'
                            // ratios
  double spread = 0;        // of that ratio: interquartile range / median
  int repeats = 0;          // at least 9
  int max_count_error = 0;  // of 255, against double precision, over a sample of lines
  double share_differing = 0;
};

struct BenchReport {
  std::string cpu;
  double fftw_c2c_ns = 0; // median over all repeats
  double ring_mb = 0;
  std::vector<BenchResult> cases;
};

// Measures every path, instruction set and interpolation, with and without dispersion, on one and
// two threads; with dispersion, all three backgrounds. Takes about `seconds` in all.
hal::Result<BenchReport> bench_reconstruct(double seconds);

std::string to_text(const BenchReport& report);
std::string to_json(const BenchReport& report);

} // namespace octascope::firmware_host
