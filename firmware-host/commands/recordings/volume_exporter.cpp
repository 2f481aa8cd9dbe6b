#include "firmware-host/commands/recordings/volume_exporter.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "firmware-host/commands/level_picture.h"
#include "firmware-host/version/version.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/recordings/dicom/dicom_writer.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::firmware_host {

namespace {

using pipeline::Readers;
using pipeline::RecordingFacts;

std::string this_program() {
  return fmt::format("octascope {}", version());
}

class NrrdExporter : public VolumeExporter {
public:
  NrrdExporter(const ExportOptions& options, const RecordingFacts& facts)
      : facts_(facts), subject_(options.subject.value_or(facts.subject)),
        type_(options.display_counts ? pipeline::NrrdType::uint8 : pipeline::NrrdType::float32) {}

  hal::Result<> write(const std::filesystem::path& file, const VolumeToExport& from) override {
    HAL_TRY(auto writer, pipeline::NrrdWriter::create(file, facts_.geometry, type_, notes(from),
                                                      Readers::owner));
    for (int b = 0; b < facts_.geometry.b_scans; ++b) {
      const auto counts = from.volume.b_scan(b);
      HAL_CHECK(type_ == pipeline::NrrdType::uint8 ? writer.write_b_scan(b, counts)
                                                   : writer.write_b_scan(b, decibels(counts)));
    }
    return writer.commit();
  }

  std::uint64_t file_bytes() const override {
    return facts_.geometry.voxels() * (type_ == pipeline::NrrdType::uint8 ? 1 : sizeof(float));
  }

private:
  std::span<const float> decibels(std::span<const std::uint8_t> counts) {
    levels_db_.resize(counts.size());
    std::ranges::transform(counts, levels_db_.begin(), [](std::uint8_t count) {
      return pipeline::level_db(static_cast<float>(count));
    });
    return levels_db_;
  }

  pipeline::NrrdNotes notes(const VolumeToExport& from) const {
    pipeline::NrrdNotes all{
        {"SIMULATED", facts_.simulated ? "yes, some or all of it is not the patient's" : "no"},
        {"volume", fmt::format("{}", from.n)},
        {"index", fmt::format("{}", from.entry.index)},
        {"recording_begun", facts_.begun},
        {"wall_clock_ns", fmt::format("{}", from.entry.wall_clock_ns)},
        {"source", facts_.source},
        {"recorded_by", facts_.recorded_by},
        {"exported_by", this_program()}};
    if (!subject_.empty())
      all.emplace_back("subject", subject_);
    if (facts_.eye != pipeline::Eye::not_said)
      all.emplace_back("eye", to_string(facts_.eye));
    std::string missing;
    for (std::size_t b = 0; b < from.volume.b_scan_states.size(); ++b) {
      if (from.volume.b_scan_states[b] == pipeline::BScanState::missing && missing.size() < 1000)
        missing += fmt::format("{}{}", missing.empty() ? "" : " ", b);
    }
    if (!missing.empty())
      all.emplace_back("missing_b_scans", missing);
    return all;
  }

  const RecordingFacts& facts_;
  std::string subject_;
  pipeline::NrrdType type_;
  std::vector<float> levels_db_;
};

class DicomExporter : public VolumeExporter {
public:
  explicit DicomExporter(pipeline::DicomWriter writer) : writer_(std::move(writer)) {}

  hal::Result<> write(const std::filesystem::path& file, const VolumeToExport& from) override {
    return writer_.write(file, from.volume, from.entry, from.n);
  }
  std::uint64_t file_bytes() const override { return writer_.file_bytes(); }

private:
  pipeline::DicomWriter writer_;
};

class PngExporter : public VolumeExporter {
public:
  explicit PngExporter(const ExportOptions& options)
      : b_scan_(options.b_scan), window_(options.window), to_scale_(options.to_scale) {}

  hal::Result<> write(const std::filesystem::path& file, const VolumeToExport& from) override {
    const pipeline::VolumeGeometry& g = from.volume.geometry;
    const pipeline::Image stored =
        b_scan_ ? draw_b_scan(from.volume, *b_scan_, *window_) : draw_en_face(from.volume, window_);
    if (!to_scale_)
      return pipeline::write_png(file, stored, Readers::owner);
    const auto image =
        to_scale(stored, g.a_spacing_um, b_scan_ ? g.depth_spacing_um : g.b_spacing_um);
    return image ? pipeline::write_png(file, *image, Readers::owner)
                 : hal::Result<>{tl::make_unexpected(image.error())};
  }
  std::uint64_t file_bytes() const override { return 0; }

private:
  std::optional<int> b_scan_;
  std::optional<ui::DisplayWindow> window_;
  bool to_scale_;
};

} // namespace

hal::Result<std::unique_ptr<VolumeExporter>>
make_volume_exporter(const ExportOptions& options, const RecordingFacts& facts,
                     const pipeline::RecordedVolume& first) {
  using Made = std::unique_ptr<VolumeExporter>;
  switch (options.format) {
  case ExportFormat::nrrd: return Made{std::make_unique<NrrdExporter>(options, facts)};
  case ExportFormat::png: return Made{std::make_unique<PngExporter>(options)};
  case ExportFormat::dicom: break;
  }
  HAL_TRY(auto writer, pipeline::DicomWriter::create(
                           facts, first,
                           {.window = {options.window->offset_db, options.window->size_db},
                            .patient_id = options.subject,
                            .exported_by = this_program()}));
  return Made{std::make_unique<DicomExporter>(std::move(writer))};
}

} // namespace octascope::firmware_host
