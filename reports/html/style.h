#pragma once

#include <string_view>

namespace rondure::reports {

/// Style of the page. The colours (Okabe and Ito's, darkened for text) can be told apart by
/// colour-blind readers and in grey print; nothing is expressed by colour alone. Colours that
/// follow the theme are variables; those of data (diverging_colour()) are the same on light and
/// dark.
inline constexpr std::string_view kStyle = R"css(
:root{--paper:#fff;--ink:#16202a;--soft:#55616d;--line:#d8dee4;--pale:#f4f6f8;--blue:#0b5e9e;
--orange:#c24e00;--good:#00715a;--bad:#b93c00;--amber:#8a6100;--warn:#d99a00;--alarm:#fdf3ec;
--tick:#7c8792;--grid:#e6eaee;--label:#3c4752;--band:#eef2f6;--allowed:#e9edf1;--mean:#8a949e;
--guide:#6b7681;--trail:#9aa5af;--edge:#59636d;--solid:#dfe6ec;--cap:#edf1f5;--focus:#0b5e9e;
color-scheme:light}
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%;text-size-adjust:100%}
body{margin:0;background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,
"Noto Sans","Noto Sans CJK SC","PingFang SC","Microsoft YaHei",Arial,sans-serif;
font-variant-numeric:tabular-nums;overflow-wrap:anywhere;-webkit-print-color-adjust:exact;
print-color-adjust:exact}
main{max-width:1080px;margin:0 auto;padding:22px 28px 40px}
.skip{position:absolute;left:-999px;top:0;background:var(--paper);color:var(--ink);padding:8px 14px;z-index:1}
.skip:focus{left:8px;top:8px}
a{color:var(--blue)}
:focus-visible{outline:3px solid var(--focus);outline-offset:2px;border-radius:2px}
.top{max-width:1080px;margin:0 auto;padding:18px 28px 0;display:flex;flex-wrap:wrap;justify-content:space-between;
align-items:center;gap:8px 20px;font-size:13px}
.top nav ul{display:flex;flex-wrap:wrap;gap:4px 18px;margin:0;padding:0;list-style:none}
button{font:inherit;font-size:13px;color:var(--ink);background:var(--pale);border:1px solid var(--tick);border-radius:4px;
padding:3px 11px;min-height:28px;min-width:28px;cursor:pointer}
button[aria-pressed=true]{background:var(--ink);color:var(--paper)}
button[hidden],.tools[hidden]{display:none}
.spoken{position:absolute;width:1px;height:1px;overflow:hidden;clip-path:inset(50%);white-space:nowrap}
caption{text-align:left;font-weight:600;font-size:13.5px;padding:4px 0}
.print-only{display:none}
.brand{display:flex;justify-content:space-between;align-items:baseline;gap:4px 24px;flex-wrap:wrap;font-size:13px;
border-bottom:2px solid var(--ink);padding-bottom:8px}
.brand .kind{font-weight:650;font-size:15px}.lab{min-width:190px}.lab img{display:block;max-height:40px;max-width:190px}
.fill{border-bottom:1px solid var(--tick);min-width:64px;min-height:1.2em;flex:1 1 auto}
.ident{display:grid;grid-template-columns:1.2fr 1.2fr 1.3fr 1fr;gap:4px 22px;border-bottom:1px solid var(--line);
padding:8px 0;font-size:13px;line-height:1.4}
.ident dl{margin:0}.ident div{display:flex;gap:7px}.ident dt,.lines dt{color:var(--soft);white-space:nowrap}.ident dd{margin:0}
h1{font-size:17px;line-height:1.25;font-weight:650;margin:0}
h2{font-size:20px;font-weight:650;line-height:1.3;margin:52px 0 12px;padding-top:18px;
border-top:1px solid var(--line)}
h3{font-size:15px;font-weight:650;margin:30px 0 6px}
p{margin:6px 0}
.facts{display:flex;flex-wrap:wrap;gap:2px 26px;color:var(--soft);font-size:13.5px;margin:0}
.facts div{display:flex;gap:7px}.facts dt{white-space:nowrap}.facts dd{margin:0;color:var(--ink)}
.note{color:var(--soft);font-size:13px}
.banner{border:1px solid var(--line);border-left:5px solid var(--blue);background:var(--pale);
padding:5px 14px;margin:8px 0 0;border-radius:3px;font-size:13.5px}
.banner.alarm{border-left-color:var(--bad);background:var(--alarm)}
.banner ul{margin:4px 0 0;padding-left:20px}
.verdict{display:flex;align-items:center;gap:14px;margin:16px 0 8px}
.verdict .mark{flex:none}
.verdict .word{font-size:28px;line-height:1.1;font-weight:700;letter-spacing:-.01em}
.verdict .why{font-size:15px;margin-top:2px}
.is-conforms{color:var(--good)}.is-does-not-conform{color:var(--bad)}.is-undecided{color:var(--amber)}
.is-void,.is-not-toleranced{color:var(--soft)}
table{border-collapse:collapse;width:100%;font-size:13.5px;margin:12px 0}
th{text-align:left;font-weight:600;color:var(--soft);font-size:12.5px;border-bottom:1.5px solid var(--ink);
padding:5px 10px 5px 0;vertical-align:bottom}
td{padding:6px 10px 6px 0;border-bottom:1px solid var(--line);vertical-align:top}
th{overflow-wrap:normal}th.n,td.n{text-align:right;white-space:nowrap;padding-right:22px}
table.props th{width:190px;border-bottom:1px solid var(--line);font-weight:400;vertical-align:top;padding-top:6px}
th:last-child,td:last-child{padding-right:0}
table.results{font-size:12.5px;margin:10px 0 4px;overflow-wrap:break-word}
table.results td{vertical-align:middle;padding:3px 8px 3px 0}table.results th{padding:3px 8px 3px 0}
table.results td.n,table.results th.n{padding-right:9px}
table.results .value{font-weight:700;font-size:inherit;color:inherit}.place{white-space:nowrap}sup{line-height:0}table.results small{color:var(--soft)}
table.results .verdict-word{font-weight:650;white-space:nowrap}
table.results tr:has(.is-does-not-conform) td{background:var(--alarm)}
.bar{max-width:none;vertical-align:middle}table.results .verdict-word .mark{max-width:none;vertical-align:-2px;margin-right:5px}
.views{display:grid;grid-template-columns:repeat(auto-fit,minmax(300px,1fr));gap:0 20px;break-inside:avoid}
.worst-one{display:grid;grid-template-columns:minmax(0,2fr) minmax(0,3fr);gap:0 20px;align-items:start}
.said{fill:var(--label);font-size:11.5px;paint-order:stroke;stroke:var(--paper);stroke-width:3px}
.said.first{font-weight:650;fill:var(--ink)}.worst{fill:none;stroke:var(--bad);stroke-width:2}
.lines{display:block;border-top:1px solid var(--line);margin:12px 0 0;padding-top:6px;font-size:13px}
.lines>div{display:grid;grid-template-columns:96px 1fr;gap:8px;margin:2px 0}.lines dd{margin:0}
.foot{display:grid;grid-template-columns:1fr 1.6fr;gap:24px;border-top:2px solid var(--ink);margin-top:10px;padding-top:8px}
.sign-box{border:1px solid var(--tick);min-height:52px;padding:3px 8px;font-size:12px;color:var(--soft)}
.foot .facts{display:block;font-size:12px}
.fold{border-top:1px solid var(--line);margin:14px 0;padding-top:8px}details{margin:8px 0}summary{cursor:pointer;font-size:13.5px}
.gates .mark{vertical-align:-3px;margin-right:4px}
.gates td small{display:block;color:var(--soft);font-size:12.5px}
.plain{font-size:13.5px}
.frame-box{display:inline-flex;border:1.2px solid var(--ink);font-size:12px;line-height:1;vertical-align:middle;
white-space:nowrap}.frame-box .symbol{width:14px;height:14px}
.frame-box>*{padding:2px 5px;display:flex;align-items:center}.frame-box>*+*{border-left:1.2px solid var(--ink)}
.id{font-weight:650}
.keys{display:grid;grid-template-columns:repeat(auto-fill,minmax(190px,1fr));gap:16px 24px;margin:14px 0 6px}
.keys dt{color:var(--soft);font-size:12.5px}.keys dd{margin:1px 0 0;font-size:15.5px;font-weight:600}
.keys dd small{display:block;font-weight:400;font-size:12.5px;color:var(--soft);line-height:1.4}
.keys .lead dd{font-size:25px;line-height:1.25}
.keys .wide-key{grid-column:1/-1}.keys .wide-key dd{font-weight:400;font-size:14px}
.truth{border:1px dashed var(--soft);padding:8px 14px;margin:16px 0;font-size:13.5px;border-radius:3px}
.warnings{margin:14px 0;padding:0;list-style:none}
.warnings li{border-left:4px solid var(--warn);padding:3px 12px;margin:6px 0;font-size:13.5px}
.code{font:12px ui-monospace,"DejaVu Sans Mono",Menlo,Consolas,monospace;color:var(--soft)}
.mono{font:12.5px ui-monospace,"DejaVu Sans Mono",Menlo,Consolas,monospace}
figure{margin:10px 0 18px}
figcaption{color:var(--soft);font-size:12.5px;margin-top:4px}
.scroll{overflow-x:auto}
svg{display:inline-block;max-width:100%;height:auto;font-family:inherit}
svg.wide{display:block;width:100%;max-width:760px;margin:0 auto}
svg.polar{display:block;width:100%;max-width:340px;margin:0 auto}
.multiples{display:grid;grid-template-columns:repeat(auto-fit,minmax(270px,1fr));gap:12px 20px}
.multiples.single{grid-template-columns:minmax(0,360px);justify-content:center}
.multiples.pairs{grid-template-columns:repeat(2,minmax(0,1fr));max-width:720px;margin:0 auto}
.multiples figure{margin:6px 0;text-align:center}.multiples figcaption b{color:var(--ink)}
.key{vertical-align:-1px}
.mark .good{fill:var(--good)}.mark .bad{fill:var(--bad)}
.mark .stroke{fill:none;stroke:var(--paper);stroke-width:7;stroke-linecap:round;stroke-linejoin:round}
.mark .hollow{fill:var(--paper);stroke:var(--soft);stroke-width:5}.mark .open{fill:var(--paper);stroke:var(--amber);stroke-width:4}
.mark .pen{fill:none;stroke:var(--soft);stroke-width:5;stroke-linecap:round}
.symbol{fill:none;stroke:var(--ink);stroke-width:1.5}
.bar .allowed{fill:var(--allowed)}.bar .good{fill:var(--good)}.bar .bad{fill:var(--bad)}.bar .neutral{fill:var(--soft)}
.bar .limit{stroke:var(--ink);stroke-width:2}
.rule{border:1px solid var(--line);padding:8px 14px;margin:14px 0;font-size:13.5px;border-radius:3px}
.rule dl{margin:6px 0 0}.rule dt{color:var(--soft);font-size:12.5px}.rule dd{margin:0 0 4px}
.tick,.frame{stroke:var(--tick);stroke-width:1;fill:none}.grid{stroke:var(--grid);stroke-width:1}
.label{fill:var(--label);font-size:12px}.title{fill:var(--label);font-size:12.5px}
.band{fill:var(--band);stroke:none}
.uncertainty{fill:var(--blue);fill-opacity:.16;stroke:none}
.zone-outer{fill:none;stroke:var(--orange);stroke-width:1.3}.zone-inner{fill:none;stroke:var(--blue);stroke-width:1.3}
.mean{fill:none;stroke:var(--mean);stroke-width:1;stroke-dasharray:5 4}
.profile{fill:none;stroke:var(--ink);stroke-width:1;stroke-linejoin:round}
.guide{fill:none;stroke:var(--guide);stroke-width:1;stroke-dasharray:2 3}
.point{fill:var(--ink)}.outer{fill:var(--orange);stroke:var(--paper);stroke-width:.8}.inner{fill:var(--blue);stroke:var(--paper);stroke-width:.8}
.scale{fill:none;stroke:var(--ink);stroke-width:1.5}
.disc{stroke:var(--edge);stroke-width:.6}.disc.contact{stroke:var(--ink);stroke-width:1.8}
.value{fill:#16202a;font-size:10px}.value.light{fill:#fff}
.trail{fill:none;stroke:var(--trail);stroke-width:1}.pose{fill:var(--ink)}.pose.virtual{fill:var(--paper);stroke:var(--ink);stroke-width:1.2}
.final{fill:var(--orange);stroke:var(--paper);stroke-width:1}.no-value{fill:none;stroke:var(--soft);stroke-width:1.5}
.reference{stroke:var(--blue);stroke-width:1.3;stroke-dasharray:7 4}
.chart .control{stroke:var(--blue);stroke-width:1.2;stroke-dasharray:6 4}.chart .center{stroke:var(--blue);stroke-width:1}
.chart .limit{stroke:var(--ink);stroke-width:2}.chart .run{fill:none;stroke:var(--trail);stroke-width:1}
.chart .result{fill:var(--ink)}.chart .beyond{fill:var(--orange)}.chart .cross{fill:none;stroke:var(--bad);stroke-width:2.2}
.solid-glass{fill:var(--orange);fill-opacity:.05;stroke:var(--orange);stroke-width:1.2}
.solid-body{fill:var(--solid);fill-opacity:.8;stroke:var(--blue);stroke-width:1.2}
.solid-cap{fill:var(--cap);fill-opacity:.75;stroke:var(--blue);stroke-width:1}
.solid-axis{stroke:var(--soft);stroke-width:1;stroke-dasharray:9 3 2 3;fill:none}
.ring{fill:none;stroke-width:1}.ring.outside{stroke:var(--orange)}.ring.section{stroke:var(--guide);stroke-dasharray:2 3}
.ring.section.dense{stroke:var(--ink);stroke-dasharray:none}
path.away{opacity:.4}.far circle,.far path:not(.ring){opacity:.75}
.turn{touch-action:pan-y;cursor:grab;display:block}.turn:active{cursor:grabbing}
.tools{display:flex;flex-wrap:wrap;gap:6px;align-items:center;justify-content:center;margin:4px 0;font-size:12.5px;color:var(--soft)}
.tools output{min-width:16em;text-align:center}
footer{max-width:1024px;margin:0 auto 48px;padding:12px 0 0;border-top:1px solid var(--line);color:var(--soft);font-size:12.5px}
@media screen and (max-width:1079px){
table.results,table.results tbody{display:block}table.results thead{display:none}
table.results tr{display:flex;flex-wrap:wrap;align-items:center;gap:2px 16px;padding:8px 0;border-bottom:1px solid var(--line)}
table.results td,table.results td.n{border:0;padding:0;text-align:left;white-space:normal}table.results td:empty{display:none}
table.results td[data-l]:before{content:attr(data-l) " ";margin-right:3px;color:var(--soft);font-size:12.5px;font-weight:400}
}
@media screen and (max-width:640px){
main{padding:14px 16px 32px}.top{padding:12px 16px 0}footer{margin:0 16px 40px}.ident,.worst-one,.foot{grid-template-columns:minmax(0,1fr)}
table.props th{width:104px}.scroll table{min-width:560px}
.scroll svg.wide{width:600px;max-width:none}.multiples.single{grid-template-columns:minmax(0,360px);justify-content:center}
.multiples.pairs{grid-template-columns:1fr}
}
@page{margin:13mm 13mm 12mm;@bottom-right{content:counter(page) " / " counter(pages);font:8pt system-ui,sans-serif;color:#55616d}}
@media print{
.screen-only,details:not([open]){display:none!important}.print-only{display:block}
body{font-size:8.5pt;line-height:1.35}table{font-size:8pt}th,.note{font-size:7.5pt}main{max-width:none;padding:0}.scroll{overflow:visible}
#result{break-after:page;page-break-after:always}.brand,.ident,.lines{font-size:8pt;line-height:1.3}.ident{padding:4px 0}.brand{padding-bottom:4px}.brand .kind,h1{font-size:11pt}
.verdict{margin:5px 0 3px}.verdict .mark{width:36px;height:36px}.sign-box{min-height:44px;font-size:7.5pt}.foot{margin-top:6px;padding-top:5px}.foot .facts{font-size:7.5pt}.lines{margin-top:6px;padding-top:4px}.lines>div{margin:1px 0}.verdict .word{font-size:18pt}.verdict .why{font-size:10pt}.banner{padding:2px 10px;margin:4px 0 0;font-size:8.5pt}
table.results{font-size:7.5pt;line-height:1.2}table.results th{font-size:7.5pt}table.results td{padding:1.5px 6px 1.5px 0}
table.results .bar{width:68px}.plain{font-size:7.5pt}.frame-box{font-size:7pt}.frame-box>*{padding:1px 3px}.frame-box .symbol{width:10px;height:10px}
#result h3{margin:8px 0 2px;font-size:9.5pt}#result figure{margin:2px 0}#result figcaption,#result .note{font-size:7pt;line-height:1.25}
#result svg.polar{max-width:190px}#result svg.wide{max-width:400px}
th.n,td.n{padding-right:14px}
figure,tr,.verdict,.banner,.rule,.truth,.keys>div,.warnings li,.foot,.lines,.worst-one{break-inside:avoid;page-break-inside:avoid}
table.short{break-inside:avoid;page-break-inside:avoid}
h2,h3{break-after:avoid;page-break-after:avoid}h2{margin:10px 0 6px;padding-top:6px;font-size:12pt}h3{margin:8px 0 2px}table{margin:6px 0}.warnings{margin:6px 0}.warnings li{font-size:8.5pt;padding:1px 10px}h3+p,h2+p{break-after:avoid;page-break-after:avoid}
thead{display:table-header-group}
td{padding-top:1px;padding-bottom:1px}table.props th{padding-top:1px}p{margin:3px 0}.rule{margin:6px 0;padding:4px 12px;font-size:9pt}footer{margin-top:6px;padding-top:0;border:0;font-size:8pt}
.multiples,.multiples.pairs,.multiples.single{display:block;max-width:none;text-align:center;orphans:1;widows:1}
.multiples figure{display:inline-block;width:32%;vertical-align:top;margin:2px 0}svg.polar{max-width:175px}svg.wide{max-width:440px}figure{margin:4px 0 8px}
.keys{gap:6px 18px}.facts,figcaption{font-size:8pt}
}
)css";

/// What a page with characteristics of a drawing needs beside kStyle.
inline constexpr std::string_view kDrawingStyle = R"css(
.frame-box .deviations{display:inline-flex;flex-direction:column;font-size:9.5px;line-height:1.15;margin-left:4px}
.frame-box .modifier{border:1.1px solid var(--ink);border-radius:9px;font-size:10px;line-height:1;padding:2px 4px;
margin-left:5px;min-width:16px;text-align:center}
.side-by-side{display:grid;grid-template-columns:repeat(3,minmax(0,1fr));gap:0 28px;align-items:start}
.side-by-side td{padding:2px 8px 2px 0}.side-by-side th.n,.side-by-side td.n{padding-right:0}
.span{fill:var(--guide)}.span.worst{fill:var(--orange)}
.span-limit{stroke:var(--ink);stroke-width:1.6;stroke-dasharray:7 4}
.window{fill:var(--soft);fill-opacity:.22;stroke:none}
svg.face{max-width:520px}.face .label{paint-order:stroke;stroke:var(--paper);stroke-width:3px}
@media screen and (max-width:640px){.side-by-side{grid-template-columns:1fr}}
@media print{svg.face{max-width:300px}.frame-box .deviations{font-size:6pt;line-height:1.05}.frame-box .modifier{font-size:6pt;padding:0 3px;min-width:12px;margin-left:3px}.frame-box.size>*{padding:0 3px}
.side-by-side{gap:0 20px}h2+p+p,h3+p+p,h3~.warnings{break-after:avoid}}
)css";

/// The colours of the dark theme: every text and every mark has the contrast required by WCAG 2.1
/// AA (4.5, and 3 for graphics). Print never uses them.
inline constexpr std::string_view kDarkColours =
    "--paper:#12181f;--ink:#e8edf2;--soft:#a6b2be;--line:#2e3944;--pale:#1b232c;--blue:#62b0ea;"
    "--orange:#f0954b;--good:#2fc296;--bad:#ff8b5e;--amber:#e2b23e;--warn:#d99a00;--alarm:#2b1d16;"
    "--tick:#7f8c98;--grid:#27313b;--label:#bac5cf;--band:#1d2731;--allowed:#2b3641;--mean:#76838f;"
    "--guide:#94a1ad;--trail:#66737f;--edge:#a9b8c5;--solid:#2b3742;--cap:#36434f;--focus:#8fc8f2;"
    "color-scheme:dark";

}  // namespace rondure::reports
