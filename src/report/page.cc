// The page around its sections: style, order, heading.

#include "report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "gloam/program.h"
#include "report/svg_chart.h"

namespace gloam {
namespace {

constexpr const char* kStyle = R"(
*{box-sizing:border-box}body{margin:0 auto;max-width:1240px;padding:28px 24px 60px;background:var(--paper);color:var(--ink);font:14px/1.5 system-ui,sans-serif}
h1{font-size:26px;line-height:1.2;margin:0 0 4px;overflow-wrap:anywhere}h2{font-size:18px;margin:38px 0 10px;padding-top:10px;border-top:1px solid var(--line)}h3{font-size:14px;margin:18px 0 6px}
p{margin:6px 0;max-width:84ch}.soft{color:var(--soft)}.scroll{overflow-x:auto}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}th,td{padding:4px 12px 4px 0;text-align:left;vertical-align:top;border-bottom:1px solid var(--line)}
th{font-weight:600;white-space:nowrap}td.n,th.n{text-align:right;padding-left:12px;white-space:nowrap}td.best{background:var(--mark);font-weight:600}tr.head td{font-weight:600;padding-top:14px}
code{font:12px ui-monospace,monospace;overflow-wrap:anywhere}.tag{white-space:nowrap}.tag svg{vertical-align:-1px;margin-right:6px}
.legend{display:flex;flex-wrap:wrap;gap:4px 20px;margin:6px 0 12px;position:sticky;top:0;background:var(--paper);padding:6px 0;z-index:1}
.charts{display:grid;grid-template-columns:repeat(auto-fill,minmax(440px,1fr));gap:14px 20px}.charts svg{width:100%;height:auto}
.strip{display:grid;gap:4px;margin:4px 0 14px;align-items:center}.strip img{width:100%;height:auto;display:block;cursor:zoom-in;border-radius:2px}
.strip .row{font-weight:600;padding-right:8px;overflow-wrap:anywhere}.strip .row .tag{white-space:normal}.strip .time{color:var(--soft);font-size:12px;text-align:center}.strip .gap{background:var(--panel);color:var(--soft);font-size:12px;text-align:center;padding:18px 0}
.note{background:var(--panel);padding:8px 12px;border-radius:4px;margin:10px 0}.bad{color:var(--c1);font-weight:600}
dialog{border:0;padding:0;background:#000;max-width:96vw}dialog img{display:block;width:92vw;height:auto;max-height:90vh;object-fit:contain}dialog p{color:#ddd;margin:4px 8px}
@media print{body{max-width:none;padding:0;font-size:11px}h2{break-after:avoid}.charts svg,.strip,tr{break-inside:avoid}.legend{position:static}.scroll{overflow:visible}.charts{grid-template-columns:1fr 1fr}}
@page{size:A4 landscape;margin:12mm}
)";

constexpr const char* kScript = R"(
const d=document.querySelector('dialog');
document.addEventListener('click',e=>{if(e.target.matches('.strip img')){d.querySelector('img').src=e.target.src;
d.querySelector('p').textContent=e.target.alt;d.showModal()}else if(d.open)d.close()});
)";

std::string joined(const std::set<std::string>& texts) {
  std::string out;
  for (const std::string& text : texts) out += (out.empty() ? "" : ", ") + text;
  return out;
}

}  // namespace

std::string run_tag(const RunResults& run) {
  return fmt::format(
      R"(<span class="tag"><svg width="22" height="10" aria-hidden="true"><path class="curve {}" d="M0 5H22"/></svg>{}</span>)",
      curve_class(run.color), html_text(run.label));
}

std::vector<std::string> result_names(const std::vector<RunResults>& runs) {
  std::vector<std::string> names;
  for (const RunResults& run : runs)
    for (const auto& [name, value] : run.results)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

std::string header_section(const ReportContent& content) {
  std::set<std::string> scenes, versions;
  double simulated = 0;
  for (const RunResults& run : content.runs) {
    if (!run.scene_file.empty()) scenes.insert(run.scene_file);
    for (const auto& [name, value] : run.versions)
      if (name != "configuration") versions.insert(name + " " + value);
    simulated += run.simulated;
  }
  std::string out = fmt::format(
      "<h1>{}</h1><p class=\"soft\">{} run{}{}, {} s of simulation; {}</p>",
      html_text(content.title), content.runs.size(), content.runs.size() == 1 ? "" : "s",
      scenes.empty() ? "" : " of " + html_text(joined(scenes)), short_number(simulated),
      html_text(joined(versions)));
  for (const RunGroup& motion : content.motions) {
    std::string names;
    for (const size_t i : motion.runs)
      names += (names.empty() ? "" : ", ") + html_text(content.runs[i].label);
    const std::string proof =
        motion.label.empty()
            ? "their robots are at the same positions at all times"
            : "they end in the same state (hash <code>" + html_text(motion.label) + "</code>)";
    out += fmt::format(
        "<p class=\"note\"><b>One motion:</b> {}: {}. They differ only in sensor data and "
        "measurements.</p>",
        names, proof);
  }
  return out;
}

std::string left_out_section(const ReportContent& content) {
  if (content.left_out.empty()) return {};
  std::string out = "<h2>Omitted</h2><ul>";
  for (const Error& error : content.left_out)
    out += "<li>" + html_text(error.to_string()) + "</li>";
  return out + "</ul>";
}

std::string report_page(const ReportContent& content) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">"
      "<meta name=\"color-scheme\" content=\"light dark\">"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">"
      "<title>{}</title><style>{}{}</style></head><body>\n",
      html_text(content.title), chart_style(), kStyle);
  for (const auto section :
       {header_section, pictures_section, success_section, groups_section, results_section,
        ground_section, curves_section, runs_section, left_out_section})
    out += section(content) + "\n";
  out += fmt::format(
      "<p class=\"soft\">Created by gloam report, version {}. This file is "
      "self-contained.</p><dialog><img "
      "alt=\"\"><p></p></dialog><script>{}</script></body></html>\n",
      html_text(version()), kScript);
  return out;
}

}  // namespace gloam
