#include "firmware-host/commands/commission/commission_report.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "firmware-host/outputs/local_time.h"
#include "firmware-host/version/version.h"

namespace octascope::firmware_host {

namespace {

constexpr std::string_view head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>octascope commissioning</title><style>
body{font:11pt/1.5 system-ui,sans-serif;color:#1c2430;max-width:48rem;margin:2.5rem auto;padding:0 1rem}
h1{font-size:1.7rem;margin:0 0 .3rem}h2{font-size:1.15rem;margin:2.2rem 0 .4rem;border-top:1px solid #c9d0d8;padding-top:.8rem}
p{margin:.3rem 0}table{border-collapse:collapse;width:100%}td,th{text-align:left;vertical-align:top;padding:.25rem .8rem .25rem 0}
td{overflow-wrap:anywhere}td:first-child{color:#55606d;width:13rem}th{border-bottom:1px solid #c9d0d8}
img{display:block;max-width:100%;max-height:150mm;border:1px solid #dde2e8}
.warning{background:#fdf3dc;border-left:4px solid #c98a00;padding:.4rem .8rem;margin:.5rem 0}
.simulated{background:#e8eef6;border-left:4px solid #2f5f9e;padding:.4rem .8rem;margin:.8rem 0}
.failed{background:#fbe6e4;border-left:4px solid #b3261e;padding:.4rem .8rem;margin:.5rem 0}
figure{margin:.8rem 0}figcaption,.quiet{color:#55606d}pre{background:#f4f6f8;padding:.6rem .8rem;white-space:pre-wrap;font-size:9.5pt}
section{break-inside:avoid}
@media print{body{margin:0;max-width:none;font-size:10pt}@page{margin:18mm}}
</style></head><body>
)";

std::string escaped(std::string_view text) {
  std::string html;
  for (const char letter : text)
    switch (letter) {
    case '&': html += "&amp;"; break;
    case '<': html += "&lt;"; break;
    case '>': html += "&gt;"; break;
    case '"': html += "&quot;"; break;
    default: html += letter;
    }
  return html;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream{file, std::ios::binary}.rdbuf();
  return bytes.str();
}

struct Caption {
  std::string_view stem; // of the picture's file, which may have a number after it
  std::string_view text;
};
constexpr std::array captions{
    Caption{"spectrum",
            "The spectrum of the mirror: a broad hill of light with a fine fringe on it, "
            "nowhere at the upper edge, which is full scale."},
    Caption{"dark", "The light of the reference arm alone: a smooth hill without a fringe."},
    Caption{"mirror_near", "The mean line of the near mirror: the hill with a fringe."},
    Caption{"mirror_far", "The mean line of the far mirror: a finer fringe than the near one's."},
    Caption{
        "calibration",
        "From the top: what interferes, the curve to wavenumber, the phases, and the mirrors' "
        "point spreads before and after. The last should be narrow peaks where broad ones were."},
    Caption{"tissue",
            "A B-scan with this calibration, depth downwards: the surface should be a sharp "
            "line, with tissue below it rather than above."},
    Caption{"target", "The target from above, A-scans to the right and B-scans down: an upright F "
                      "between its bars, light on dark, all of it in the picture."}};

std::string_view caption_of(std::string_view picture) {
  for (const Caption& caption : captions)
    if (picture.starts_with(caption.stem) && picture.size() > caption.stem.size() &&
        (picture[caption.stem.size()] == '.' || picture[caption.stem.size()] == '-'))
      return caption.text;
  return {};
}

std::string_view title_of(std::span<const ReportedStep> steps, std::string_view key) {
  const auto step = std::ranges::find(steps, key, &ReportedStep::key);
  return step == steps.end() ? key : step->title;
}

// "done", with what is wrong with it.
std::string state_of(const Session& session, std::string_view key) {
  const std::string outcome = session.outcome(key);
  std::string state = outcome.empty() ? "not done yet" : outcome;
  const std::size_t warnings = session.record(key).warnings.size();
  if (warnings > 0)
    state += fmt::format(", {} warning{}", warnings, warnings == 1 ? "" : "s");
  if (!session.outdated_by(key).empty())
    state += ", outdated";
  if (!session.failure(key).empty())
    state += outcome == "done" ? ", failed when it was repeated" : ", failed";
  return state;
}

std::string figure_of(const Session& session, const std::string& name) {
  const std::string bytes = bytes_of(session.folder() / std::filesystem::path{name}.filename());
  if (bytes.empty())
    return fmt::format("<p class=\"quiet\">{} cannot be read</p>\n", escaped(name));
  return fmt::format("<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\">"
                     "<figcaption>{}</figcaption></figure>\n",
                     escaped(name), base64(bytes), escaped(caption_of(name)));
}

std::string section_of(const Session& session, const ReportedStep& step,
                       std::span<const ReportedStep> steps) {
  const StepRecord record = session.record(step.key);
  std::string html = fmt::format("<section><h2>{}</h2>\n", escaped(step.title));
  if (const std::string newer = session.outdated_by(step.key); !newer.empty())
    html += fmt::format("<p class=\"warning\"><b>Outdated:</b> done before \"{}\" was last done."
                        "</p>\n",
                        escaped(title_of(steps, newer)));
  if (const std::string why = session.failure(step.key); !why.empty())
    html +=
        fmt::format("<p class=\"failed\"><b>The last attempt failed:</b> {}</p>\n", escaped(why));
  if (record.found.empty())
    html += fmt::format("<p class=\"quiet\">{}</p>\n", state_of(session, step.key));
  else
    html += "<table>\n";
  for (const auto& [what, value] : record.found)
    html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped(what), escaped(value));
  if (!record.found.empty())
    html += "</table>\n";
  for (const std::string& warning : record.warnings)
    html += fmt::format("<p class=\"warning\">{}</p>\n", escaped(warning));
  for (const std::string& name : record.pictures)
    html += figure_of(session, name);
  return html + "</section>\n";
}

// As it lies there, edited or not.
std::string configuration_section(const Session& session) {
  const std::string text = bytes_of(session.folder() / "octascope.toml");
  return text.empty() ? std::string{}
                      : fmt::format("<section><h2>octascope.toml</h2>\n<pre>{}</pre></section>\n",
                                    escaped(text));
}

} // namespace

std::string base64(std::string_view bytes) {
  static constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto byte = [&](std::size_t i) {
    return i < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) : 0U;
  };
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::uint32_t group = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
    text += letters[group >> 18U & 63U];
    text += letters[group >> 12U & 63U];
    text += i + 1 < bytes.size() ? letters[group >> 6U & 63U] : '=';
    text += i + 2 < bytes.size() ? letters[group & 63U] : '=';
  }
  return text;
}

std::string commission_report(const Session& session, std::span<const ReportedStep> steps) {
  std::string html{head};
  html +=
      fmt::format("<h1>Commissioning</h1>\n<p class=\"quiet\">{} · octascope {} · not a medical "
                  "device</p>\n",
                  escaped(now_in_iso_8601()), escaped(version()));
  if (session.simulated())
    html += "<p class=\"simulated\">SIMULATED: found on the twins; nothing here is of a real "
            "instrument.</p>\n";
  html += "<table>\n<tr><th>step</th><th>state</th></tr>\n";
  for (const ReportedStep& step : steps)
    html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped(step.title),
                        escaped(state_of(session, step.key)));
  html += "</table>\n";
  for (const ReportedStep& step : steps)
    html += section_of(session, step, steps);
  return html + configuration_section(session) + "</body></html>\n";
}

} // namespace octascope::firmware_host
