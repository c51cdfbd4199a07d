// Style of the page. Colours by Okabe and Ito 2008, Color universal design, distinguishable with
// any colour vision; no meaning depends on colour alone.
#pragma once

#include <string_view>

namespace glint {

// Style of figures, on the page and in separate files. Light by default; dark by preference.
inline constexpr std::string_view k_figure_colours = R"css(
:root{--ink:#1b1f24;--faint:#5b6570;--line:#d5dae0;--grid:#e9ecef;--paper:#ffffff;--panel:#f6f7f9;
--bound:#0066a8;--estimate:#a35a00;--observed:#00795a;--bad:#b5400a;--good:#00795a;
--n0:#9ecae9;--n1:#ffd28a;--n2:#9fdcc5;--n3:#f3e79b;--n4:#e7b7d3;--n5:#c9ced6;--n6:#f4b590;--n7:#bfb8e6;
--block-ink:#16191d}
@media screen and (prefers-color-scheme:dark){:root{--ink:#e7eaee;--faint:#a3adb8;--line:#3a424c;
--grid:#2b3138;--paper:#14171b;--panel:#1c2127;--bound:#6cb8f0;--estimate:#f0ad4e;--observed:#4fd0a5;
--bad:#ff8a5c;--good:#4fd0a5}}
)css";

inline constexpr std::string_view k_figure_style = R"css(
svg{font-family:system-ui,-apple-system,"Segoe UI","Helvetica Neue",Arial,"Liberation Sans",sans-serif;
font-variant-numeric:tabular-nums;max-width:100%;height:auto}
svg text{fill:var(--ink);font-size:12px}svg text.faint{fill:var(--faint)}svg text.small{font-size:10.5px}
svg text.end{text-anchor:end}svg text.middle{text-anchor:middle}svg text.strong{font-weight:600}
svg text.inblock{fill:var(--block-ink);font-size:11px;text-anchor:middle}
svg text.bound{fill:var(--bound)}svg text.bad{fill:var(--bad)}svg text.observed{fill:var(--observed)}
svg text.estimate{fill:var(--estimate)}
svg .axis{stroke:var(--faint);stroke-width:1}svg .grid{stroke:var(--grid);stroke-width:1}
svg .boundline{stroke:var(--bound);stroke-width:1.6}
svg .deadline{stroke:var(--bad);stroke-width:1.6;stroke-dasharray:5 3}
svg .observedline{stroke:var(--observed);stroke-width:1.6}
svg .lane{fill:var(--panel)}svg .fill-bound{fill:var(--bound)}svg .fill-estimate{fill:var(--estimate)}
svg .fill-observed{fill:var(--observed)}svg .fill-declared{fill:var(--faint)}svg .fill-bad{fill:var(--bad)}
svg .dot{stroke:var(--paper);stroke-width:.5}
svg .n0{fill:var(--n0)}svg .n1{fill:var(--n1)}svg .n2{fill:var(--n2)}svg .n3{fill:var(--n3)}
svg .n4{fill:var(--n4)}svg .n5{fill:var(--n5)}svg .n6{fill:var(--n6)}svg .n7{fill:var(--n7)}
svg .block{stroke:var(--paper);stroke-width:.8}svg .late{stroke:var(--bad);stroke-width:1.8}
svg .tick{fill:none;stroke:var(--ink);stroke-width:1}
)css";

inline constexpr std::string_view k_page_style = R"css(
*{box-sizing:border-box}html{-webkit-text-size-adjust:100%}
body{margin:0;background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,-apple-system,"Segoe UI",
"Helvetica Neue",Arial,"Liberation Sans",sans-serif;font-variant-numeric:tabular-nums}
.page{max-width:1180px;margin:0 auto;padding:28px 32px 64px}
header{border-bottom:2px solid var(--ink);padding-bottom:14px;margin-bottom:20px}
h1{font-size:26px;line-height:1.2;margin:0;font-weight:650;letter-spacing:-.01em}
header p{margin:4px 0 0;color:var(--faint)}
h2{font-size:19px;line-height:1.3;margin:44px 0 10px;padding-top:10px;border-top:1px solid var(--line);font-weight:650}
h2 .number{color:var(--faint);font-weight:400;margin-right:.5em}
p{max-width:78ch;margin:8px 0}p.faint{color:var(--faint)}p.bad{color:var(--bad);font-weight:600}
p.good{color:var(--good)}
.verdict{display:flex;gap:16px;align-items:flex-start;border-left:6px solid var(--faint);background:var(--panel);padding:14px 18px;margin:18px 0}
.verdict .mark{font-size:15px;font-weight:700;letter-spacing:.04em;white-space:nowrap;padding-top:1px}
.verdict.holds{border-color:var(--good)}.verdict.holds .mark{color:var(--good)}
.verdict.fails{border-color:var(--bad)}.verdict.fails .mark{color:var(--bad)}
.verdict p{margin:0 0 4px}.verdict ul{margin:6px 0 0;padding-left:18px}
.verdict li{max-width:85ch;margin:2px 0}.verdict li.bad{color:var(--bad)}
.tiles{display:grid;grid-template-columns:repeat(3,1fr);gap:14px;margin:18px 0}
.tile{border:1px solid var(--line);border-top:4px solid var(--line);padding:12px 16px}
.tile.bound{border-top-color:var(--bound)}.tile.estimate{border-top-color:var(--estimate);border-top-style:double}
.tile.observed{border-top-color:var(--observed);border-top-style:dashed}
.tile .kind{font-size:13px;font-weight:650}.tile .value{font-size:27px;line-height:1.25;font-weight:600;letter-spacing:-.01em}
.tile .value.words{font-size:19px;padding:4px 0}
.tile .what{margin:0}.tile .from{color:var(--faint);font-size:13px;margin:4px 0 0;overflow-wrap:anywhere}
.bound .kind,th.bound{color:var(--bound)}.estimate .kind,th.estimate{color:var(--estimate)}
.observed .kind,th.observed{color:var(--observed)}
nav{margin:18px 0 0}nav ol{columns:3;column-gap:32px;margin:6px 0;padding-left:22px;font-size:14px}
nav a{color:inherit;text-decoration:none;border-bottom:1px solid var(--line)}nav a:hover{border-color:currentColor}
.scroll{overflow-x:auto;margin:14px 0}
table{border-collapse:collapse;font-size:13.5px;line-height:1.4}
p.caption{color:var(--faint);font-size:13.5px;max-width:105ch;margin:18px 0 4px}p.caption+.scroll{margin-top:4px}
th,td{padding:4px 12px 4px 0;text-align:left;vertical-align:top;border-bottom:1px solid var(--grid)}
thead th{border-bottom:1.5px solid var(--faint);font-weight:600;vertical-align:bottom}
td.number,th.number{text-align:right;padding-left:8px}td.number{white-space:nowrap}
tbody tr:hover{background:var(--panel)}td code{overflow-wrap:anywhere}
td.good{color:var(--good)}td.bad{color:var(--bad);font-weight:650}td.faint{color:var(--faint)}
figure{margin:16px 0}figcaption{color:var(--faint);font-size:13px;max-width:100ch;margin-top:2px}
.grid{display:grid;grid-template-columns:repeat(auto-fill,minmax(340px,1fr));gap:6px 18px;margin:14px 0}
.grid figure{margin:0}
pre{background:var(--panel);border:1px solid var(--line);padding:8px 12px;overflow-x:auto;font-size:13px;margin:8px 0}
code,td code{font-family:ui-monospace,SFMono-Regular,Menlo,Consolas,"Liberation Mono",monospace;font-size:.93em}
footer{margin-top:48px;border-top:1px solid var(--line);padding-top:10px;color:var(--faint);font-size:13px}
@media (max-width:760px){.page{padding:18px}.tiles{grid-template-columns:1fr}nav ol{columns:1}}
@page{size:A4;margin:14mm 13mm}
@media print{body{font-size:10.5pt}.page{max-width:none;padding:0}nav{display:none}
h2{break-after:avoid;margin-top:20pt}table{font-size:8.6pt}figure,.tile,.verdict,tr{break-inside:avoid}
thead{display:table-header-group}.scroll{overflow:visible}.grid{grid-template-columns:repeat(2,1fr)}
.verdict,.tile,svg,.lane{-webkit-print-color-adjust:exact;print-color-adjust:exact}tbody tr:hover{background:none}
th,td{padding-right:7px}pre{white-space:pre-wrap}}
)css";

}  // namespace glint
