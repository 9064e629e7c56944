#include "reports/language_zh.h"

namespace rondure::reports {
namespace {

constexpr Translation kTexts[] = {
    {"{} of {}", "{} / {}"},
    {"Touches made", "已完成的触测"},
    {"Time left", "剩余时间"},
    {"as the plan's time model predicts, at the pace so far",
     "按检测方案的时间模型和目前的进度预计"},
    {"Time so far", "已用时间"},
    {"live view", "实时视图"},
    {"Locating {}, pose {}", "正在找正 {}，位姿 {}"},
    {"Measuring {}, pose {}", "正在测量 {}，位姿 {}"},
    {"no real part is measured.", "不测量真实工件。"},
    {"f of this pose", "本位姿的 f"},
    {"of the touches so far", "按目前的触测"},
    {"Minimum zone", "最小区域"},
    {"The drawings begin when the touches of this pose define the feature.",
     "本位姿的触测足以确定要素后开始绘图。"},
    {"The present cloud", "当前点云"},
    {"Every {}th point is drawn while the run is at work; the report has all of them.",
     "检测进行中每隔 {} 点绘出一点；报告中有全部点。"},
    {"Last touches", "最近的触测"},
    {"Touch", "触测"},
    {"Purpose", "用途"},
    {"Point", "点"},
    {"Centres of the tip in the machine frame, the newest first. Each is on disk before the next "
     "is made.",
     "机器坐标系中的测头中心，最新的在前。每次触测在下一次之前已写入磁盘。"},
    {"Run finished", "检测已完成"},
    {"Run stopped; it can go on with rondure run --resume",
     "检测已停止；可用 rondure run --resume 继续"},
    {"Run ended by a fault", "检测因故障结束"},
    {"The report is in", "报告位于"},
    {"The program has ended; this page stays as it is.", "程序已结束；本页保持现状。"},
    {"Stop the run", "停止检测"},
    {"The run stops after the present touch.", "检测将在当前触测后停止。"},
    {"The program did not take this; use Ctrl-C in its terminal.",
     "程序未接受此操作；请在其终端中按 Ctrl-C。"},
    {"To stop the run from here, open the address that the program printed, with all that stands "
     "behind the #.",
     "要在此处停止检测，请打开程序给出的完整地址，包括 # 之后的部分。"},
    {"Stop the run?", "停止检测？"},
    {"The machine ends the present touch, goes back and up, and everything measured is kept. The "
     "run can go on later with rondure run --resume. This is no emergency stop.",
     "测量机完成当前触测后退回并抬起，已测数据全部保留。以后可用 rondure run --resume "
     "继续。这不是急停。"},
    {"Go on measuring", "继续测量"},
    {"Rondure: live view", "Rondure：实时视图"},
    {"This page needs JavaScript.", "本页需要 JavaScript。"},
    {"Connection lost.", "连接中断。"},
    {"The program does not answer: it has ended, or this computer is very busy. Its terminal "
     "tells; what was measured is on disk.",
     "程序没有响应：可能已结束，或本机非常繁忙。请查看其终端；已测数据在磁盘上。"},
    {"Served by Rondure on this computer only. The drawings are those of the report, of the "
     "touches so far.",
     "仅由本机上的 Rondure 提供。图形与报告相同，按目前的触测绘制。"},
    {"The run is over. Verdict:", "检测结束。判定："},
    {"No result", "没有结果"},
};

}  // namespace

std::span<const Translation> chinese_live() { return kTexts; }

}  // namespace rondure::reports
