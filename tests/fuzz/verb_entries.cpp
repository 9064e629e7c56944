#include "tests/fuzz/verb_entries.h"

#include <array>
#include <filesystem>

#include "app/verbs/verbs.h"
#include "tests/app/files.h"
#include "tests/fuzz/cases.h"
#include "tests/fuzz/overheard.h"

namespace rondure::fuzz {
namespace {

using app::testing::write;

/// The bytes behind the first as a file.
std::string file_of(std::string_view bytes) {
  const std::filesystem::path file = work_folder() / "in.csv";
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

}  // namespace rondure::fuzz
