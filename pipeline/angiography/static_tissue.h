// What decorrelation static tissue would show of noise and residual motion alone, and how far above
// that a voxel lies.
//
// Of bins S + N with noise of power σ², the same S in both repeats, numerator and denominator of the
// decorrelation differ by ½Σ|N1 − N2|² (the terms S·conj(N) cancel). So, with the mean power I of
// the kernel, which holds the noise as well, and n independent samples in it,
//   D = σ²/I · (1 ± 1/√n):
// a line through the origin of decorrelation against inverse signal-to-noise ratio, with a spread
// that falls with the kernel; as found by L. Huang, Y. Fu, R. Chen et al., "SNR-adaptive OCT
// angiography enabled by statistical characterization of intensity and decorrelation with
// multi-variate time series model", IEEE Trans. Med. Imaging 38, 2695 (2019). Of M repeats, the
// M − 1 pairs share sweeps; the eigenvalues 1 − cos(πk/M) of that quadratic form give n a factor of
// 1, 1.6 and 2.25 for M = 2, 3 and 4.
// Intensities: ½Σ(I1 − I2)² has the mean σ²(2⟨I⟩ − σ²) a sample, so D = σ²(2⟨I⟩ − σ²)/⟨I²⟩; the
// terms are squares of real numbers weighted by speckle, so that the spread is twice as large.
//
// σ² is measured: in static tissue it is D·I, in noise I. The lower quantile over the A-scans, for 32
// depths at a time, is the noise there; at most twice that of the quietest depths, lest a
// layer of vessels be taken for noise. Depths that repeats do not share have their neighbours'. What is left of motion, galvo jitter and interpolation
// decorrelates static tissue in proportion to its signal: d0, the lower quantile of
// (D − σ²/I)/(1 − σ²/I) over voxels that are well lit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace octascope::pipeline {

enum class FlowMethod : std::uint8_t {
  complex_bins, // more sensitive, with half the spread
  intensity,    // where phases cannot be trusted
};

// Values of a B-scan, [a][z]; level and second_moment as in kernel_sums.h.
struct KernelPlanes {
  std::span<const float> decorrelation;
  std::span<const float> level;
  std::span<const float> second_moment; // of intensities; empty otherwise
};

class StaticTissue {
public:
  // A voxel must be this much brighter than noise; below, nothing can be told of it.
  static constexpr float least_level = 1.6F;

  StaticTissue(FlowMethod method, int a_scans, int depths, int repeats);

  // Measures noise and d0 in one B-scan. `depth_samples`: independent samples in the kernel's depths.
  void measure(const KernelPlanes& planes, float depth_samples) noexcept;

  // 0 static … 1 flowing, NaN below least_level and where there is no power: u⁴/(1 + u⁴), where 3u is the distance of D above the
  // line in spreads; so it is ½ at three of them. Tails: flow below a vessel stays only where the
  // decorrelation without noise is about half of the vessel's or more, which real vessels reach and
  // their tails do not, however far below: all the light from there went through the vessel. As in
  // projection-resolved angiography (M. Zhang et al., Biomed. Opt. Express 7, 816, 2016).
  void classify(const KernelPlanes& planes, std::span<float> flow) noexcept;

  std::span<const float> noise() const { return noise_; } // power of each depth
  float static_decorrelation() const { return d0_; }
  // Voxels are well lit, enough of them to measure d0; otherwise it is 0, and no flow can be told.
  bool is_lit() const { return is_lit_; }
  // There is tissue, and most of it has decorrelated: repeats of different places, or moved too far.
  bool incoherent() const { return incoherent_; }

private:
  float noise_at(const KernelPlanes& planes, std::size_t i) const;
  // NaN where there is no power.
  template <class Value>
  float lower_quantile(const KernelPlanes& planes, int begin, int end, const Value& value) noexcept;
  void measure_noise(const KernelPlanes& planes) noexcept;
  void fill_empty_blocks() noexcept;
  void measure_static(const KernelPlanes& planes) noexcept;

  FlowMethod method_;
  int a_scans_;
  int depths_;
  int step_;           // between the A-scans, and the depths, that quantiles are taken of
  float pair_factor_;  // independent samples of decorrelation a sample of the kernel
  float level_factor_; // likewise of the level
  float samples_ = 1;
  float level_samples_ = 1;
  float d0_ = 0;
  bool is_lit_ = false;
  bool incoherent_ = false;
  std::vector<float> noise_;
  std::vector<float> blocks_;
  std::vector<float> values_;      // to take quantiles of
  std::vector<std::int32_t> keys_; // likewise
  // Of one A-scan, while it is classified: decorrelation without noise; that of
  // vessels, and its maximum above each depth.
  std::vector<float> excess_;
  std::vector<float> vessels_;
  std::vector<float> shadows_;
};

} // namespace octascope::pipeline
