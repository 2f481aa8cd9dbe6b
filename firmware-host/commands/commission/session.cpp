#include "firmware-host/commands/commission/session.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "firmware-host/commands/commission/step_order.h"
#include "firmware-host/outputs/local_time.h"
#include "firmware-host/version/version.h"
#include "pipeline/files/atomic_file.h"
#include "pipeline/files/toml_text.h"

namespace octascope::firmware_host {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* state_file = "commission.json";
constexpr const char* working_file = "working.toml";

hal::Result<> make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder, error))
    return hal::fail(hal::ErrorCode::denied, "{}: cannot be made: {}; name another folder",
                     folder.string(), error ? error.message() : "it is a file");
  return {};
}

bool is_text(const Json& value) {
  return value.is_string();
}

bool is_revision(const Json& value) {
  constexpr unsigned most = 1'000'000'000;
  return value.is_number_unsigned() && value.get<std::uint64_t>() < most;
}

bool holds_only(const Json& object, bool (*is_sound)(const Json&)) {
  return object.is_object() && std::ranges::all_of(object, is_sound);
}

// What tells whether a step is outdated. Folders of before have neither.
bool has_sound_revisions(const Json& step) {
  return (!step.contains("revision") || is_revision(step["revision"])) &&
         (!step.contains("made_of") || holds_only(step["made_of"], is_revision));
}

// As save() writes it.
bool is_state(const Json& json) {
  if (!json.is_object() || !json.contains("steps") || !json["steps"].is_object() ||
      !json.contains("values") || !json["values"].is_object() || !json.contains("simulated") ||
      !json["simulated"].is_boolean())
    return false;
  if (json.contains("failures") && !holds_only(json["failures"], is_text))
    return false;
  for (const auto& [name, value] : json["values"].items())
    if (!value.is_string() && !value.is_number())
      return false;
  const auto texts = [](const Json& step, const char* key) {
    if (!step.contains(key) || !step[key].is_array())
      return false;
    for (const Json& text : step[key])
      if (!text.is_string())
        return false;
    return true;
  };
  for (const auto& [name, step] : json["steps"].items()) {
    if (!step.is_object() || !step.contains("outcome") || !step["outcome"].is_string() ||
        !texts(step, "warnings") || !texts(step, "pictures") || !step.contains("found") ||
        !step["found"].is_object() || !has_sound_revisions(step))
      return false;
    for (const auto& [what, value] : step["found"].items())
      if (!value.is_string())
        return false;
  }
  return true;
}

// Values that were set anew are the same in another order.
nlohmann::json sorted(const Json& values) {
  return values;
}

} // namespace

hal::Result<Session> Session::open(const std::filesystem::path& folder, bool simulate) {
  HAL_CHECK(make_folder(folder));
  Session session{folder, simulate};
  session.state_ = {{"program", fmt::format("octascope {}", version())},
                    {"simulated", simulate},
                    {"steps", Json::object()},
                    {"values", Json::object()}};
  std::error_code error;
  if (std::filesystem::exists(folder / state_file, error)) {
    std::ifstream stream{folder / state_file, std::ios::binary};
    Json kept = Json::parse(stream, nullptr, false);
    if (!is_state(kept))
      return hal::fail(hal::ErrorCode::bad_data,
                       "{}: is damaged, or of another program; move it away to begin anew",
                       (folder / state_file).string());
    if (kept["simulated"] != simulate)
      return hal::fail(hal::ErrorCode::invalid_argument,
                       "{}: was begun {} --sim, expected the same; name another folder",
                       folder.string(), simulate ? "without" : "with");
    session.state_ = std::move(kept);
  } else if (!std::filesystem::is_empty(folder, error)) {
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "{}: has files in it that are not of a commissioning; name a new folder",
                     folder.string());
  }
  session.values_ = session.state_["values"];
  HAL_CHECK(session.save()); // now rather than after the first step: can it be written?
  return session;
}

std::string Session::text(std::string_view key, std::string_view fallback) const {
  const auto found = values_.find(std::string{key});
  return found != values_.end() && found->is_string() ? found->get<std::string>()
                                                      : std::string{fallback};
}

double Session::number(std::string_view key, double fallback) const {
  const auto found = values_.find(std::string{key});
  return found != values_.end() && found->is_number() ? found->get<double>() : fallback;
}

void Session::set(std::string_view key, Json value) {
  values_[std::string{key}] = std::move(value);
}

void Session::unset(std::string_view key) {
  values_.erase(std::string{key});
}

std::string Session::outcome(std::string_view step) const {
  const Json& steps = state_["steps"];
  const auto found = steps.find(std::string{step});
  return found == steps.end() ? std::string{} : (*found)["outcome"].get<std::string>();
}

StepRecord Session::record(std::string_view step) const {
  StepRecord record;
  const Json& steps = state_["steps"];
  const auto kept = steps.find(std::string{step});
  if (kept == steps.end())
    return record;
  for (const auto& [what, value] : (*kept)["found"].items())
    record.found.emplace_back(what, value.get<std::string>());
  record.warnings = (*kept)["warnings"].get<std::vector<std::string>>();
  record.pictures = (*kept)["pictures"].get<std::vector<std::string>>();
  return record;
}

// Rises whenever the step brought other values than it had; 0: it never brought any.
int Session::revision(std::string_view step) const {
  const Json& steps = state_["steps"];
  const auto kept = steps.find(std::string{step});
  return kept == steps.end() ? 0 : kept->value("revision", 0);
}

std::string Session::outdated_by(std::string_view step) const {
  if (outcome(step) != "done")
    return {};
  const Json& kept = state_["steps"][std::string{step}];
  const Json used = kept.value("made_of", Json::object());
  for (const std::string_view part : made_of(step))
    if (used.value(std::string{part}, 0) != revision(part))
      return std::string{part};
  for (const std::string_view part : made_of(step))
    if (std::string cause = outdated_by(part); !cause.empty())
      return cause;
  return {};
}

std::string Session::failure(std::string_view step) const {
  const auto failures = state_.find("failures");
  return failures == state_.end() ? std::string{} : failures->value(std::string{step}, "");
}

hal::Result<> Session::keep(std::string_view step, const StepRecord& record) {
  Json found = Json::object();
  for (const auto& [what, value] : record.found)
    found[what] = value;
  Json used = Json::object();
  for (const std::string_view part : made_of(step))
    used[std::string{part}] = revision(part);
  const bool brought = sorted(values_) != sorted(state_["values"]);
  const int now = revision(step) + (brought ? 1 : 0);
  state_["values"] = values_;
  if (state_.contains("failures"))
    state_["failures"].erase(std::string{step});
  state_["steps"][std::string{step}] = {
      {"outcome", "done"},          {"at", now_in_iso_8601()},   {"revision", now},
      {"made_of", std::move(used)}, {"found", std::move(found)}, {"warnings", record.warnings},
      {"pictures", record.pictures}};
  return save();
}

hal::Result<> Session::fail(std::string_view step, std::string_view why) {
  forget();
  state_["failures"][std::string{step}] = why;
  return save();
}

hal::Result<> Session::skip(std::string_view step) {
  forget();
  if (outcome(step) == "done")
    return {}; // what was found stays
  state_["steps"][std::string{step}] = {{"outcome", "skipped"},
                                        {"at", now_in_iso_8601()},
                                        {"found", Json::object()},
                                        {"warnings", Json::array()},
                                        {"pictures", Json::array()}};
  return save();
}

void Session::forget() {
  values_ = state_["values"];
}

hal::Result<> Session::save() const {
  return pipeline::write_atomically(
      folder_ / state_file,
      state_.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

std::filesystem::path Session::free_file(std::string_view stem, std::string_view extension) const {
  std::error_code error;
  std::filesystem::path file = folder_ / fmt::format("{}{}", stem, extension);
  for (int n = 2; std::filesystem::exists(std::filesystem::symlink_status(file, error)); ++n)
    file = folder_ / fmt::format("{}-{}{}", stem, n, extension);
  return file;
}

std::optional<std::filesystem::path> Session::file(std::string_view key) const {
  const std::string name = text(key);
  return name.empty() ? std::nullopt : std::optional{folder_ / name};
}

std::string Session::configuration_toml() const {
  std::string toml =
      fmt::format("# Found by octascope commission, version {}; report.html beside it "
                  "says how.\n\n[devices]\nline_camera = {}\n",
                  version(), pipeline::toml_text(text("line_camera", "auto")));
  if (!simulate_) {
    toml += fmt::format("trigger_line = {}\npulse_width_us = {}\n",
                        pipeline::toml_text(text("trigger_line", "octascope-trigger")),
                        number("pulse_width_us", 50));
    if (const std::string sync = text("sync_line"); !sync.empty())
      toml += fmt::format("sync_line = {}\n", pipeline::toml_text(sync));
    for (const char* const key : {"significant_bits", "exposure_us", "gain"})
      if (values_.contains(key))
        toml += fmt::format("{} = {}\n", key, number(key, 0));
  }
  if (values_.contains("samples"))
    toml +=
        fmt::format("\n[scan]\nsamples = {}\na_scans = {}\nfly_back_lines = {}\nb_scans = {}\n"
                    "line_rate_hz = {}\na_spacing_um = {:.5g}\nb_spacing_um = {:.5g}\n",
                    number("samples", 1024), number("a_scans", 300), number("fly_back_lines", 79),
                    number("b_scans", 80), number("line_rate_hz", 215e3),
                    number("a_spacing_um", 10), number("b_spacing_um", 37.5));
  if (const std::string calibration = text("calibration"); !calibration.empty())
    toml += fmt::format("\n[calibration]\nfile = {}\n", pipeline::toml_text(calibration));
  if (const std::string device = text("control_device"); !device.empty())
    toml += fmt::format("\n[controls]\ndevice = {}\nfile = {}\n", pipeline::toml_text(device),
                        pipeline::toml_text(text("control_profile")));
  return toml;
}

hal::Result<RunOptions> Session::run_options(std::string_view phantom) const {
  // Without the background of a loop that nobody watches.
  HAL_CHECK(pipeline::write_atomically(folder_ / working_file,
                                       configuration_toml() + "\n[sim]\nloop_volumes = 1\n"));
  RunOptions options;
  options.configuration = folder_ / working_file;
  options.display = DisplayChoice::offscreen; // made, never opened
  options.simulate = simulate_;
  if (simulate_)
    options.phantom = phantom;
  return options;
}

hal::Result<Configuration> Session::configuration() const {
  return load_configuration(folder_ / working_file);
}

} // namespace octascope::firmware_host
