#include "reports/words/zh.h"

namespace rondure::reports {
namespace {

constexpr Translation kSummaryTexts[] = {
    {"rule", "规则"},
    {", serial {}", "，序列号 {}"},
    {"no real part was measured", "未测量真实工件"},
    {"not finished", "未完成"},
    {"the run has no end on record", "记录中没有结束标记"},
    {"reason", "原因"},
    {"missing", "缺少"},
    {"{} um, {:g} % within [{}, {}] um {}", "{0} um，{1:g} % 包含区间 [{2}, {3}] um，{4}"},
    {"corrected", "修正"},
    {"noise {} um", "噪声 {} um"},
    {", sparse sampling {} um", "，稀疏采样 {} um"},
    {"; most of the spread {}: {} ({:.0f} %)", "；{}的主要来源：{} ({:.0f} %)"},
    {"bias", "偏差"},
    {"note", "注"},
    {"no value", "无值"},
    {"limit {} um", "公差 {} um"},
    {"no limit", "无公差"},
    {"because", "原因"},
    {"stated", "完整表述"},
    {"{} of {}, the one that departs most", "{}，共 {} 层，偏差最大的一层"},
    {"the circles are {} um apart", "两圆相距 {} um"},
    {"{} contact outside", "{} 外接触点"},
    {"{} contact inside", "{} 内接触点"},
    {"zone", "区域"},
    {"radii {} and {} mm {}", "半径 {} 和 {} mm，{}"},
    {"of the surface", "实际表面"},
    {"of the points, tip unknown", "按各点，测头未知"},
    {", gap {} um", "，间隙 {} um"},
    {"certificate", "证明"},
    {"{} radius {} mm, {} {} um", "{} 半径 {} mm，{} {} um"},
    {"one-sided", "单侧基准"},
    {", difference {} um", "，差值 {} um"},
    {"{} (of the simulation, not of the measurement)", "{}（属于仿真，不属于测量）"},
    {"{}: {} {}, {}", "{0}：{1}{2}，{3}"},
    {"feature", "要素"},
    {"no result", "没有结果"},
    {"warning", "警告"},
    {"motion", "运动误差"},
    {"eccentricity", "偏心"},
    {"noise gain", "噪声增益"},
    {"path", "路径"},
    {"no path", "无路径"},
    {"stability", "稳定性"},
    {"fixture", "夹具"},
    {"before", "补偿前"},
    {"compensated", "补偿后"},
    {"{}: {}, {}", "{}：{}，{}"},
    {", ", "，"},
    {"; ", "；"},
};

}  // namespace

std::span<const Translation> chinese_summary() { return kSummaryTexts; }

}  // namespace rondure::reports
