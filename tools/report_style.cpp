#include "tools/report_style.hpp"

namespace forager::tools {

// Text and marks keep a contrast of 4.5 to 1 with what lies behind them (WCAG 2 AA), lines 3 to 1; kinds of
// decision differ by letter, tags by fill, not by colour alone.
std::string_view report_style() {
  return R"css(
:root{color-scheme:light dark;--page:#f5f5f2;--card:#fff;--ink:#1a1f26;--soft:#5a6472;--rule:#e3e4e1;
--box:#e4e2da;--box-edge:#a39f92;--path:#7c8694;--read:#0c8a72;--unread:#c8400a;--mark-text:#fff;
--f:#1f66bd;--tl:#5a3fb8;--tr:#b02a6b;--tb:#8a5a00;--s:#5d6673;--l:#1a1f26;
--p0:#1f66bd;--p1:#0a7f69;--p2:#a36a00;--p3:#b02a6b;--p4:#5a3fb8;--p5:#4d7c0f;--p6:#b4400a;--p7:#5d6673}
@media(prefers-color-scheme:dark){:root{--page:#101418;--card:#181d23;--ink:#eef1f4;--soft:#a3adb9;
--rule:#2b323a;--box:#2a3037;--box-edge:#5d6874;--path:#8d98a6;--read:#3cc6a5;--unread:#ff8a4c;
--mark-text:#10151a;--f:#7ab3f5;--tl:#b7abff;--tr:#f59ac4;--tb:#e6b455;--s:#a9b3be;--l:#f4f6f8;
--p0:#7ab3f5;--p1:#3cc6a5;--p2:#e6b455;--p3:#f59ac4;--p4:#b7abff;--p5:#a3d65c;--p6:#ff9d6b;--p7:#a9b3be}}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--ink);font:16px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,
"Helvetica Neue",Arial,sans-serif;font-variant-numeric:tabular-nums}
main,header,footer{max-width:1240px;margin:0 auto;padding:0 20px}
header{padding-top:36px;padding-bottom:8px}
h1{font-size:1.9rem;line-height:1.2;margin:0;letter-spacing:-.01em}
h2{font-size:1.02rem;margin:0 0 12px}
.sub{color:var(--soft);margin:6px 0 0}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(150px,1fr));gap:12px;margin:20px 0 0;padding:0}
.tiles div{background:var(--card);border:1px solid var(--rule);border-radius:10px;padding:12px 16px}
.tiles dt{color:var(--soft);font-size:.86rem}
.tiles dd{margin:0;font-size:1.5rem;font-weight:650;line-height:1.3}
.tiles small{font-size:.86rem;font-weight:400;color:var(--soft)}
.grid{display:grid;grid-template-columns:minmax(0,1fr) minmax(0,1fr);gap:16px;margin:16px 0;align-items:start}
.stack{display:grid;gap:16px;min-width:0}
.card{background:var(--card);border:1px solid var(--rule);border-radius:10px;padding:18px 20px;min-width:0}
.full{grid-column:1/-1}
@media(max-width:900px){.grid{grid-template-columns:minmax(0,1fr)}}
svg{display:block;width:100%;height:auto}
svg text{font-size:12px;fill:var(--ink)}
.axis path{stroke:var(--rule);stroke-width:1;fill:none}
.axis text{fill:var(--soft)}
.axis .kind{font-weight:650;fill:var(--ink)}
.box{fill:var(--box);stroke:var(--box-edge);stroke-width:1}
.read circle{fill:var(--read)}
.unread circle{fill:var(--card);stroke:var(--unread);stroke-width:1.8}
.path{fill:none;stroke:var(--path);stroke-width:1.6;stroke-linejoin:round;stroke-linecap:round}
.start{fill:none;stroke:var(--ink);stroke-width:1.5;stroke-dasharray:3 2.5}
.decision circle,.decision .needle{fill:var(--mark);stroke:var(--card);stroke-width:1;paint-order:stroke}
.decision .needle{stroke:none}
.decision .leader{stroke:var(--mark);stroke-width:1;fill:none}
.decision text{font-size:8px;font-weight:700;text-anchor:middle;fill:var(--mark-text)}
.tick{stroke:var(--mark);stroke-width:2}
.f{--mark:var(--f)}.tl{--mark:var(--tl)}.tr{--mark:var(--tr)}.tb{--mark:var(--tb)}.s{--mark:var(--s)}.l{--mark:var(--l)}
.p0{--port:var(--p0)}.p1{--port:var(--p1)}.p2{--port:var(--p2)}.p3{--port:var(--p3)}
.p4{--port:var(--p4)}.p5{--port:var(--p5)}.p6{--port:var(--p6)}.p7{--port:var(--p7)}
.all{--port:var(--ink)}.total{--port:var(--soft)}
.curve{fill:none;stroke:var(--port);stroke-width:1.5;stroke-linejoin:round}
.curve.all{stroke-width:2.5}
path.total{stroke:var(--soft);stroke-width:1.2;stroke-dasharray:5 4;fill:none}
.end{fill:var(--port)!important}
.end.all{font-weight:650}
.bar{fill:var(--port)}
.plot .name,.plot .value{font-size:13px}
.plot .value{font-weight:650}
.plot .faint{fill:var(--soft);font-weight:400;font-size:12px}
.legend{display:flex;flex-wrap:wrap;gap:6px 18px;margin:14px 0 0;padding:0;list-style:none;font-size:.88rem;
color:var(--soft)}
.legend li{display:flex;align-items:center;gap:7px}
.legend svg{width:22px;height:22px;flex:none}
table{border-collapse:collapse;width:100%;font-size:.94rem}
th,td{text-align:left;padding:6px 12px 6px 0;border-bottom:1px solid var(--rule);vertical-align:top;
overflow-wrap:anywhere}
tr:last-child th,tr:last-child td{border-bottom:0}
th{font-weight:400;color:var(--soft)}
thead th{font-size:.86rem}
.facts th{width:14rem;max-width:40%}
.number{text-align:right}
td.number:last-child,th.number:last-child{padding-right:0}
.events{margin:0;padding:0;list-style:none;font-size:.94rem;max-height:26rem;overflow:auto}
.events li{display:grid;grid-template-columns:5.2rem 1fr;gap:12px;padding:4px 0;border-bottom:1px solid var(--rule)}
.events li:last-child{border-bottom:0}
.events time,.events span{color:var(--soft);text-align:right}
.events p{margin:0;overflow-wrap:anywhere}
.key svg{width:20px;height:20px;vertical-align:-5px;display:inline-block;margin-right:6px}
footer{color:var(--soft);font-size:.86rem;padding-top:4px;padding-bottom:36px}
@media(max-width:600px){main,header,footer{padding-left:12px;padding-right:12px}.card{padding:14px 12px}
h1{font-size:1.5rem}svg text,.plot .name,.plot .value,.plot .faint{font-size:15px}
.tiles{grid-template-columns:1fr 1fr}.decision text{font-size:8px}}
@media print{body{background:#fff}.card,.tiles div{break-inside:avoid}.events{max-height:none}}
)css";
}

}  // namespace forager::tools
