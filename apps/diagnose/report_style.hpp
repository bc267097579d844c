// The style sheet of the report: light, plain, readable from 320 pixels of width on.
#pragma once

namespace diagnose_program {

inline constexpr const char* report_style = R"(
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0;background:#f6f6f4;color:#222;font:17px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;overflow-wrap:anywhere}
main{max-width:1080px;margin:0 auto;padding:28px 24px 60px;background:#fff}
h1{font-size:2rem;line-height:1.2;margin:.1em 0 .35em}
h2{font-size:1.3rem;line-height:1.3;margin:2.4em 0 .6em;padding-top:.9em;border-top:1px solid #e2e2de}
h3{font-size:1.05rem;margin:0 0 .3em}
p{margin:.5em 0;max-width:46em}
.model{color:#666;margin:0}
.lead{font-size:1.15rem}
.verdict{border-left:6px solid #888;padding-left:18px}
.adequate{border-color:#3a8a4d}.parameters-only{border-color:#6a9a2f}.missing-physics{border-color:#1767b5}.unexplained{border-color:#c2571a}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(150px,1fr));gap:12px;margin:1.4em 0 0}
.tile{background:#f6f6f4;border-radius:8px;padding:10px 14px;min-width:0}
.tile b{display:block;font-size:1.35rem;line-height:1.3}
.tile span,.note{color:#5c5c5c;font-size:.92rem}
.card{border:1px solid #dcdcd6;border-radius:8px;padding:14px 18px;margin:0 0 14px;min-width:0}
.rule{font-family:ui-monospace,"DejaVu Sans Mono",Menlo,monospace;font-size:.92em;background:#f6f6f4;border-radius:4px;padding:1px 6px}
table{border-collapse:collapse;width:100%;margin:.6em 0;font-size:.95rem;font-variant-numeric:tabular-nums}
th,td{text-align:left;vertical-align:top;padding:6px 10px 6px 0;border-bottom:1px solid #ebebe7}
th{font-weight:600;color:#555}
th,td{overflow-wrap:normal}
td:first-child,td:last-child{overflow-wrap:anywhere}
td.bar{width:34%}
.bar div{background:#b9cfe6;height:.8em;border-radius:3px;margin-top:.4em;min-width:2px}
.bar .chosen{background:#1767b5}.bar .plain{background:#d9731a}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,420px),1fr));gap:18px}
figure{margin:0;min-width:0}
figure svg{display:block;width:100%;height:auto}
figcaption{font-size:.92rem;color:#555;margin:0 0 2px}
ul{padding-left:1.2em;margin:.5em 0}
li{margin:.2em 0}
footer{margin-top:2.6em;color:#666;font-size:.9rem}
@media(max-width:600px){
body{font-size:16px}
main{padding:18px 16px 40px}
h1{font-size:1.6rem}
.verdict{padding-left:12px}
table{font-size:.82rem}
td:first-child{min-width:5em}
th,td{padding-right:6px}
td.bar,th.bar{display:none}
.tiles{grid-template-columns:1fr 1fr}
}
)";

}  // namespace diagnose_program
