#include "reports/words/zh.h"

namespace rondure::reports {
namespace {

constexpr Translation kLiveTexts[] = {
    {"Rondure: live view", "Rondure：实时视图"},
    {"live view", "实时视图"},
    {"no real part is measured.", "没有测量真实工件。"},
    {"Starting", "正在启动"},
    {"Qualifying the probe", "正在校准测头"},
    {"Locating {}, pose {}", "正在定位 {}，第 {} 个位姿"},
    {"Measuring {}, pose {}", "正在测量 {}，第 {} 个位姿"},
    {"All touches are made; evaluating", "全部触测已完成，正在评定"},
    {"Touches made", "已完成的触测"},
    {"{} of {}", "{}，共 {}"},
    {"Time left", "剩余时间"},
    {"as the plan's time model predicts, at the pace so far",
     "按测量方案的时间模型和目前的速度预计"},
    {"Time so far", "已用时间"},
    {"f of this pose", "本位姿的 f"},
    {"Minimum zone", "最小区域"},
    {"of the touches so far", "根据目前的触测"},
    {"The drawings begin when the touches of this pose define the feature.",
     "本位姿的触测足以确定要素后开始绘图。"},
    {"The present cloud", "当前点云"},
    {"Every {}th point is drawn while the run is at work; the report has all of them.",
     "测量进行时每 {} 个点绘制一个；报告包含全部点。"},
    {"Last touches", "最近的触测"},
    {"Touch", "触测"},
    {"Purpose", "用途"},
    {"Point", "点"},
    {"qualification", "校准"},
    {"location", "定位"},
    {"measurement", "测量"},
    {"check", "复查"},
    {"Centres of the tip in the machine frame, the newest first. Each is on disk before the next "
     "is "
     "made.",
     "测球中心，机器坐标系，最新的在最前。每次触测都先写入磁盘，再进行下一次。"},
    {"Run finished", "测量已完成"},
    {"Run stopped; it can go on with rondure run --resume",
     "测量已停止；可用 rondure run --resume 继续"},
    {"Run ended by a fault", "测量因故障结束"},
    {"The report is in", "报告位于"},
    {"The program has ended; this page stays as it is.", "程序已结束，本页不再变化。"},
    {"The run is over. Verdict:", "测量结束。结论："},
    {"No result", "无结果"},
    {"Stop the run", "停止测量"},
    {"Stop the run?", "要停止测量吗？"},
    {"The machine ends the present touch, goes back and up, and everything measured is kept. The "
     "run can go on later with rondure run --resume. This is no emergency stop.",
     "机器完成当前触测后退回并抬起，已测数据全部保留。以后可用 rondure run --resume "
     "继续。这不是急停。"},
    {"Go on measuring", "继续测量"},
    {"The run stops after the present touch.", "当前触测完成后停止。"},
    {"The program did not take this; use Ctrl-C in its terminal.",
     "程序没有接受；请在其终端按 Ctrl-C。"},
    {"To stop the run from here, open the address that the program printed, with all that stands "
     "behind the #.",
     "要在此停止测量，请打开程序显示的完整网址，包括 # 后面的全部内容。"},
    {"This page needs JavaScript.", "本页需要 JavaScript。"},
    {"Connection lost.", "连接中断。"},
    {"The program does not answer: it has ended, or this computer is very busy. Its terminal "
     "tells; what was measured is on disk.",
     "程序没有应答：它已结束，或者计算机非常繁忙。请看其终端；已测数据都在磁盘上。"},
    {"Served by Rondure on this computer only. The drawings are those of the report, of the "
     "touches "
     "so far.",
     "由本机的 Rondure 提供，仅限本机访问。图形与报告相同，根据目前的触测绘制。"},
};

}  // namespace

std::span<const Translation> chinese_live() { return kLiveTexts; }

}  // namespace rondure::reports
