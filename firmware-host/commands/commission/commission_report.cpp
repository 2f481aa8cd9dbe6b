#include "firmware-host/commands/commission/commission_report.h"

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
td:first-child{color:#55606d;width:13rem}th{border-bottom:1px solid #c9d0d8}
img{display:block;max-width:100%;max-height:150mm;margin:.8rem 0;border:1px solid #dde2e8}
.warning{background:#fdf3dc;border-left:4px solid #c98a00;padding:.4rem .8rem;margin:.5rem 0}
.simulated{background:#e8eef6;border-left:4px solid #2f5f9e;padding:.4rem .8rem;margin:.8rem 0}
.quiet{color:#55606d}section{break-inside:avoid}
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

// "done", with a warning where there is one.
std::string state_of(const Session& session, std::string_view key) {
  const std::string outcome = session.outcome(key);
  if (outcome.empty())
    return "not done yet";
  const std::size_t warnings = session.record(key).warnings.size();
  return warnings == 0
             ? outcome
             : fmt::format("{}, {} warning{}", outcome, warnings, warnings == 1 ? "" : "s");
}

std::string section_of(const Session& session, const ReportedStep& step) {
  const StepRecord record = session.record(step.key);
  std::string html = fmt::format("<section><h2>{}</h2>\n", escaped(step.title));
  if (record.found.empty())
    return html + fmt::format("<p class=\"quiet\">{}</p></section>\n", state_of(session, step.key));
  html += "<table>\n";
  for (const auto& [what, value] : record.found)
    html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped(what), escaped(value));
  html += "</table>\n";
  for (const std::string& warning : record.warnings)
    html += fmt::format("<p class=\"warning\">{}</p>\n", escaped(warning));
  for (const std::string& name : record.pictures) {
    const std::string bytes = bytes_of(session.folder() / std::filesystem::path{name}.filename());
    html += bytes.empty() ? fmt::format("<p class=\"quiet\">{} cannot be read</p>\n", escaped(name))
                          : fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">\n",
                                        escaped(name), base64(bytes));
  }
  return html + "</section>\n";
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
    html += section_of(session, step);
  return html + "</body></html>\n";
}

} // namespace octascope::firmware_host
