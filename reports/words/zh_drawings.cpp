#include "reports/words/zh.h"

namespace rondure::reports {
namespace {

constexpr Translation kDrawingTexts[] = {
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
    {"Cylinder in three dimensions", "三维圆柱"},
    {"Cylinder and its zone in three dimensions", "圆柱及其区域的三维视图"},
    {"Two coaxial cylinders {} µm apart in radius about the minimum-zone axis, {} points between "
     "them coloured by deviation, {} of them contact points.",
     "绕最小区域轴线的两个同轴圆柱，半径相差 {} µm，其间 {} 个点按偏差着色，其中 {} 个为接触点。"},
    {"turned {}°, tilted {}°", "转动 {}°，倾斜 {}°"},
    {"Turn left", "向左转"},
    {"Turn right", "向右转"},
    {"Tilt back", "向后倾"},
    {"Tilt forward", "向前倾"},
    {"Reset view", "恢复视图"},
    {"The zone between two cylinders about the minimum-zone axis (orange: outer, blue: inner) and "
     "the points, coloured by their deviation in µm; triangles touch the outer, squares the inner "
     "cylinder. Deviations are magnified {}× against the radius; heights, from the mean point, are "
     "{}.",
     "绕最小区域轴线的两个圆柱之间的区域（橙色：外，蓝色：内）和各点，按偏差着色，单位 "
     "µm；三角形为与外圆柱的接触点，方形为与内圆柱的接触点。偏差对半径放大 {} "
     "倍；高度从平均点起算，{}。"},
    {"to scale", "按比例绘制"},
    {"drawn at {:.2g}× the scale of the radius", "按半径比例的 {:.2g} 倍绘制"},
    {" Dotted lines guide the eye only.", "虚线仅为引导视线。"},
    {" {} of {} points are drawn: of each cell of 5° by 1/24 of the height the one farthest from "
     "the middle of the zone; all are in touches.csv.",
     "绘出 {1} 个点中的 {0} 个：每个 5°、1/24 高度的单元中离区域中线最远的一个；全部见 "
     "touches.csv。"},
    {" Drag it to turn it, or use the arrow keys when it has the focus; Home resets the view.",
     "拖动可旋转，或在获得焦点后用方向键；Home 键恢复视图。"},
    // Harmonics of the sections
    {"No harmonic goes beyond the limits of {}.", "没有谐波超出 {} 的限值。"},
    {"Harmonics beyond the limits of {}", "超出 {} 限值的谐波"},
    {"Layer", "层"},
    {"Amplitude / µm", "幅值 / µm"},
    {"Limit / µm", "限值 / µm"},
    {"Beyond by / µm", "超出量 / µm"},
    {"Before the filter, of each undulation in the section where it is largest. The plan gives no "
     "limits.",
     "滤波前，各次谐波取其最大的截面。检测方案未给出限值。"},
    {"Before the filter, of each undulation in the section where it is largest. Lines: the limits "
     "of the mask.",
     "滤波前，各次谐波取其最大的截面。横线：谐波限值。"},
    {"Harmonics of the sections", "截面的谐波"},
    {"Amplitudes of the harmonics", "谐波幅值"},
    {"Earlier runs", "以往结果"},
    {"Results of the same characteristics from the archive, as it was when this run was reported "
     "first; the last is this run.",
     "同一特性在归档中的结果（截至本次首次出报告时）；最后一个为本次。"},
    {"Run chart of {}", "{} 的运行图"},
    {"number of the result, in the order of time ({} to {})", "结果序号，按时间顺序（{} 至 {}）"},
    {"centre", "中心线"},
    {"tolerance", "公差"},
};

}  // namespace

std::span<const Translation> chinese_drawings() { return kDrawingTexts; }

}  // namespace rondure::reports
