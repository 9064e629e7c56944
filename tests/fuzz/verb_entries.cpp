#include "tests/fuzz/verb_entries.h"

#include <array>
#include <filesystem>

#include "app/verbs/verbs.h"
#include "tests/app/files.h"
#include "tests/fuzz/cases.h"
#include "tests/fuzz/overheard.h"
#include "tests/fuzz/seeds.h"

namespace rondure::fuzz {
namespace {

using app::testing::write;

/// The bytes behind the first as a file.
std::string file_of(std::string_view bytes, const char* name = "in.csv") {
  const std::filesystem::path file = work_folder() / name;
  write(file, bytes.substr(1));
  return file.string();
}

/// Takes the choices out of a byte, one after the other.
class Choices {
 public:
  explicit Choices(std::string_view bytes) : left_(static_cast<unsigned char>(bytes[0])) {}

  std::size_t below(std::size_t count) {
    const std::size_t out = left_ % count;
    left_ /= count;
    return out;
  }
  bool yes() { return below(2) == 1; }

 private:
  std::size_t left_;
};

/// A file with undamaged rows, written once.
std::string whole(const char* name, const std::string& text) {
  const std::filesystem::path file = work_folder() / name;
  if (!std::filesystem::exists(file)) write(file, text);
  return file.string();
}

}  // namespace

std::string try_fit(std::string_view bytes) {
  if (bytes.empty()) return {};
  Choices choices(bytes);
  app::FitArguments arguments;
  // A file with z has no circle.
  const bool flat = bytes.find('z') == std::string_view::npos;
  const std::array<const char*, 3> shapes = {"cylinder", "sphere", "line"};
  arguments.shape = flat ? "circle" : shapes[choices.below(shapes.size())];
  arguments.json = choices.yes();
  arguments.file = file_of(bytes);
  return wrong_with_answer([&] { return app::fit(arguments); });
}

std::string try_rotary_axes(std::string_view bytes) {
  if (bytes.empty()) return {};
  Choices choices(bytes);
  app::RotaryAxesArguments arguments;
  const std::array<const char*, 3> methods = {"exact", "linear", "as-published"};
  const std::array<const char*, 3> curves = {"spline", "fourier", "polynomial"};
  arguments.method = methods[choices.below(methods.size())];
  arguments.curve = curves[choices.below(curves.size())];
  arguments.json = choices.yes();
  arguments.keep_outliers = choices.yes();
  if (choices.yes()) arguments.axis = "0,0.6,0.8";
  if (choices.yes()) arguments.place_mm = {10.0, 0.0, 30.0};
  arguments.files = {file_of(bytes)};
  return wrong_with_answer([&] { return app::rotary_axes(arguments); });
}

std::string try_spindle(std::string_view bytes) {
  if (bytes.empty()) return {};
  Choices choices(bytes);
  app::SpindleArguments arguments;
  using Layout = record::SpindleTask::Layout;
  arguments.task.layout = choices.yes() ? Layout::kReference : Layout::kPublishedA;
  if (choices.yes()) {
    arguments.task.crank_radius_mm = 49.0;
    arguments.task.wheel_radius_mm = 299.88;
    arguments.task.pin_radius_mm = 24.56;
  }
  arguments.task.samples = choices.yes() ? 128 : 0;
  arguments.task.highest_order = 20;
  arguments.task.cutoff_upr = choices.yes() ? 15.0 : 0.0;
  if (choices.yes()) arguments.task.resampling = record::Switch::kOff;
  arguments.json = choices.yes();
  arguments.file = file_of(bytes);
  return wrong_with_answer([&] { return app::spindle(arguments); });
}

std::string try_roundness(std::string_view bytes) {
  if (bytes.empty()) return {};
  Choices choices(bytes);
  app::RoundnessArguments arguments;
  const std::array<const char*, 5> filters = {"none", "gaussian", "2rc", "robust", "spline"};
  const std::array<const char*, 3> passes = {"low", "high", "band"};
  arguments.filter = filters[choices.below(filters.size())];
  arguments.pass = passes[choices.below(passes.size())];
  arguments.cutoff_upr = {15.0};
  if (arguments.pass == "band") arguments.cutoff_upr.push_back(30.0);
  arguments.override_sampling = choices.yes();
  arguments.inside = choices.yes();
  arguments.json = choices.yes();
  arguments.file = file_of(bytes);
  return wrong_with_answer([&] { return app::roundness(arguments); });
}

std::string try_wheel(std::string_view bytes) {
  if (bytes.empty()) return {};
  Choices choices(bytes);
  app::WheelArguments arguments;
  using Mode = record::WheelTask::Mode;
  using Center = record::WheelTask::Center;
  arguments.task.mode = choices.yes() ? Mode::kEnvelope : Mode::kIndexed;
  if (arguments.task.mode == Mode::kIndexed && choices.yes()) arguments.axis_mm = {12.02, -7.0};
  const std::array<Center, 2> centers = {Center::kLeastSquares, Center::kAsPublished};
  arguments.task.center = centers[choices.below(centers.size())];
  if (choices.yes()) arguments.task.robust = record::Switch::kOn;
  if (choices.yes()) arguments.task.short_arc = record::WheelTask::ShortArc::kAllowed;
  arguments.json = choices.yes();
  const std::string file = file_of(bytes);
  const bool points = bytes.find("depth") == std::string_view::npos &&
                      bytes.find("surface") == std::string_view::npos;
  arguments.file = points ? file : whole("wheel.csv", wheel_tables().front());
  arguments.surface = "polynomial:0,0,0.002";
  arguments.range_mm = {-20.0, 20.0};
  arguments.step_mm = 1.0;
  if (points) return wrong_with_answer([&] { return app::wheel(arguments); });
  if (bytes.find("depth") == std::string_view::npos) {
    arguments.surface = "table:" + file;
    arguments.range_mm.clear();
  } else {
    arguments.removal = file;
  }
  return wrong_with_answer([&] { return app::wheel(arguments); });
}

std::string try_contour(std::string_view bytes) {
  if (bytes.empty()) return {};
  Choices choices(bytes);
  app::ContourArguments arguments;
  arguments.task.samples = 360;
  arguments.task.cutoff_upr = 15.0;
  using Method = record::ContourTask::Method;
  using BaseCircle = record::ContourTask::BaseCircle;
  arguments.task.method = choices.yes() ? Method::kAsPublished : Method::kCorrected;
  arguments.task.base_circle = choices.yes() ? BaseCircle::kGeometric : BaseCircle::kLimacon;
  if (choices.yes()) arguments.task.filter = record::ContourTask::Filter::kDoneByGauge;
  arguments.json = choices.yes();
  const std::string axes = whole("axes.csv", contour_tables()[0]);
  const std::string pin = whole("pin.csv", contour_tables()[1]);
  arguments.axes = {axes};
  arguments.pin = {pin};
  const std::string file = file_of(bytes);
  if (bytes.find("columns") != std::string_view::npos) {
    arguments.mapping = file;
  } else if (bytes.find("error") != std::string_view::npos ||
             bytes.find("cmd") != std::string_view::npos) {
    arguments.axes = {file};
  } else if (choices.yes()) {
    arguments.pin = {file};
  } else {
    arguments.main = {file};
  }
  return wrong_with_answer([&] { return app::contour(arguments); });
}

}  // namespace rondure::fuzz
