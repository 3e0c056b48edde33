/// `topple plan`: the whole layout from above, true to scale, with dimensions.
#include <charconv>
#include <cstdio>

#include "output.h"
#include "source.h"
#include "text.h"
#include "topple/export.h"
#include "verb.h"

namespace topple::app {
namespace {

/// "1:2.5" or "2.5" as 2.5; 0 where it is neither.
double scale_of(const std::string& words) {
  const std::string number = words.starts_with("1:") ? words.substr(2) : words;
  double scale = 0.0;
  const auto [end, problem] = std::from_chars(number.data(), number.data() + number.size(), scale);
  return problem == std::errc() && end == number.data() + number.size() && scale >= 1.0 && scale <= 100000.0 ? scale : 0.0;
}

std::string check_scale(const std::string& words) {
  return scale_of(words) > 0.0 ? std::string() : "'" + words + "' is not a scale from 1:1 to 1:100000";
}

class PlanVerb final : public Verb {
 public:
  const char* name() const override { return "plan"; }
  const char* purpose() const override { return "Draw a plan of the whole layout, true to scale, with dimensions, to print"; }
  const char* example() const override { return "topple plan scenes/s_curve.toml -o plan.pdf"; }

  void declare(Options& app) override {
    app.add_option("LAYOUT", file_, "A layout file (.toml)").required().type_name("");
    app.add_option("-o,--out", output_, "The file to write; its ending says as what").required().type_name("FILE.pdf|.svg");
    app.add_option("--scale", scale_,
                   "The scale, as 1:10; what does not fit one sheet then goes over several (default: the largest usual one that fits)")
        .type_name("1:N")
        .check(check_scale);
    app.add_option("--paper", paper_, "The paper: A4, A3, A2, A1, A0 or letter (default: the smallest on which bricks can be told apart)")
        .type_name("NAME")
        .check(one_of({"A4", "A3", "A2", "A1", "A0", "letter"}));
    app.add_option("--set", settings_, "A setting over what the file says, as often as needed").type_name("KEY=VALUE").one_word();
  }

  int run() override {
    const std::string ending = output_.extension().string();
    if (ending != ".pdf" && ending != ".svg") {
      return complain("-o " + output_.string() + ": the name must end in .pdf or .svg.", kBadInput);
    }
    if (refused_as_recording(file_, "plan")) return kBadInput;
    const Result<Layout> layout = load_layout(file_, settings_);
    if (!layout) return complain(layout.error(), kBadInput);
    if (ending == ".svg" && !scale_.empty() && !paper_.empty()) {
      return complain("An SVG is one drawing: give --scale, and it is as large as it must be, or --paper, but not both.", kBadInput);
    }
    if (const std::string why = no_place_for(output_); !why.empty()) return complain(why, kFailed);
    const Result<PlanSheets> made = draw_plan(*layout, {.scale = scale_.empty() ? 0.0 : scale_of(scale_), .paper = paper_}, output_);
    if (!made) return complain(made.error(), kFailed);
    std::printf("%s\n", words_for(*made).c_str());
    std::fprintf(stderr, "Wrote %s\n", output_.string().c_str());
    return kDone;
  }

 private:
  static std::string words_for(const PlanSheets& made) {
    const std::string paper = made.paper.empty() ? "" : " of " + made.paper;
    std::string words = formatted("1:%.4g on ", made.scale);
    words += made.sheets == 1 ? "one sheet" + paper : count_of(made.sheets, "sheet") + paper + ", and one that shows where they lie";
    if (!made.bricks) words += "; rows are drawn as lines, since a brick would be thinner than 0.3 mm";
    return words;
  }

  std::filesystem::path file_;
  std::filesystem::path output_;
  std::string scale_;
  std::string paper_;
  std::vector<std::string> settings_;
};

}  // namespace

std::unique_ptr<Verb> plan_verb() { return std::make_unique<PlanVerb>(); }

}  // namespace topple::app
