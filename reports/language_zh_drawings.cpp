#include "reports/language_zh.h"

namespace rondure::reports {
namespace {

constexpr Translation kTexts[] = {
    {"{} of {} um", "{} / {} um"},
    {", accepted up to {} um", "，接收限 {} um"},
    {"standard uncertainty by each influence alone", "各影响因素单独引起的标准不确定度"},
    {"{} µm, {} %; mean shift {} µm", "{} µm，{} %；平均偏移 {} µm"},
    {"angle about the axis / °", "绕轴线的角度 / °"},
    {"height / mm", "高度 / mm"},
    {"Deviations on the unrolled surface", "展开面上的偏差"},
    {"Unrolled surface", "展开面"},
    {"Mean deviation from the middle of the zone, in cells of 3°.",
     "相对区域中线的平均偏差，每格 3°。"},
    {"Deviation of each point from the middle of the zone in µm.",
     "各点相对区域中线的偏差，单位 µm。"},
    {"Orange: farther from the axis; blue: nearer. Triangles touch the outer, squares the inner "
     "cylinder of the zone.",
     "橙色：离轴线较远；蓝色：较近。三角形为与区域外圆柱的接触点，方形为与内圆柱的接触点。"},
    {" The number above a point is its pose.", "点上方的数字为其位姿编号。"},
    {"angle about the centre / °", "绕中心的角度 / °"},
    {"deviation / µm", "偏差 / µm"},
    {"Deviation against the angle", "偏差随角度的变化"},
    {"Unrolled section", "展开截面"},
    {"Deviation from the middle of the zone (shaded); triangles touch the outer, squares the inner "
     "circle.",
     "相对区域中线的偏差（阴影为区域）；三角形为与外圆的接触点，方形为与内圆的接触点。"},
    {"Layer {}", "第 {} 层"},
    {"no RONt", "无 RONt"},
    {"All points, seen along the axis", "沿轴线方向看的全部点"},
    {"{}: deviations about the minimum-zone axis", "{}：相对最小区域轴线的偏差"},
    {" · at {} mm", " · 高度 {} mm"},
    {"Deviations about the minimum-zone axis, magnified {}× against the radius, alike in all "
     "plots. Shaded: the zone. {} point on the outer circle, {} point on the inner circle.",
     "相对最小区域轴线的偏差，对半径放大 {} 倍，各图相同。阴影：区域。{} 外圆上的点，{} "
     "内圆上的点。"},
    {" The line guides the eye only: nothing was measured between the points.",
     "连线仅为引导视线：各点之间没有测量数据。"},
    {" The line runs through the extremes of 0.5° sectors.", "连线经过各 0.5° 扇区的极值。"},
    {" {} of {} layers are shown, evenly spaced; all are in report.json.",
     "等间隔显示 {1} 层中的 {0} 层；全部见 report.json。"},
    {"Sections", "截面"},
    {"visit", "序号"},
    {"f / µm (logarithmic)", "f / µm（对数）"},
    {"f of the poses in the order visited", "按访问顺序的各位姿 f 值"},
    {"Poses visited, coloured by f", "访问过的位姿，按 f 着色"},
    {"f against the visit. Diamond: the final pose. Open circles: poses reached in software. "
     "Crosses: no value. Dashed: the minimum zone of the final cloud.",
     "f "
     "随序号的变化。菱形：最终位姿。空心圆：软件实现的位姿。叉号：无值。虚线：最终点云的最小区域"
     "。"},
    {"Poses visited; the darker, the smaller f (logarithmic). Diamond: the final pose.",
     "访问过的位姿；颜色越深 f 越小（对数）。菱形：最终位姿。"},
};

}  // namespace

std::span<const Translation> chinese_drawings() { return kTexts; }

}  // namespace rondure::reports
