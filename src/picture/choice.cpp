// The nearest colour for every brick, as long as there are bricks of it. Which bricks go without is an assignment at least cost, found by
// prices as in an auction [Bertsekas1988]: a colour that more bricks want than there are becomes dearer by just as much as sends those
// away that lose least by it, until everybody gets what they want at these prices.
#include "picture/choice.h"

#include <algorithm>
#include <limits>

namespace topple {
namespace {

constexpr int kMostRounds = 60;            // more change nothing that can be seen; the stock is kept whatever the prices are
constexpr double kSettled = 1e-9;          // OKLab squared: nobody sees a thousandth of that
constexpr double kJustBelow = 1.0 - 1e-9;  // where all want the same, a price at which they are just not indifferent
// Floyd and Steinberg's shares [Floyd1976], but a quarter of the error is let go: else it would add up in even areas until the dearest
// colour is bought at any price.
constexpr double kCarried = 0.75;

constexpr double kStep = 1e-4;  // OKLab squared: a hundredth of white from black makes half of the least difference that people see

class Chooser {
 public:
  Chooser(const std::vector<Light>& cells, bool dither, Picture& picture)
      : cells_(cells),
        dither_(dither),
        picture_(picture),
        count_(static_cast<std::size_t>(picture.size.count)),
        here_(count_ + 2),
        below_(count_ + 2) {
    for (const StockColor& one : picture.colors) {
      lights_.push_back(light_of(one.color));
      seen_.push_back(seen(lights_.back()));
    }
    picture.cells.resize(cells.size());
    prices_.resize(lights_.size());
    margins_.resize(lights_.size());
  }

  void choose() {
    int rounds = 0;
    do {
      sweep(Whose::everybodys, false);
    } while (raise_prices() && ++rounds < kMostRounds);
    // Whatever the prices are, no colour is taken beyond its stock; who does not care leaves it to those who do.
    if (dither_) return sweep(Whose::everybodys, true);
    sweep(Whose::sure, true);
    sweep(Whose::unsure, true);
  }

 private:
  enum class Whose { everybodys, sure, unsure };
  struct Choice {
    std::size_t wanted = 0, taken = 0;
    double margin = 0.0;  ///< How much dearer the wanted colour could be.
  };

  /// One choice for each cell, or for those of one sort.
  void sweep(Whose whose, bool kept) {
    whose_ = whose;
    kept_ = kept;
    if (whose != Whose::unsure) picture_.used.assign(lights_.size(), 0);
    for (std::vector<double>& margins : margins_) margins.clear();
    std::fill(below_.begin(), below_.end(), Light{});
    for (std::size_t first = 0, row = 0; first < cells_.size(); first += count_, ++row) {
      std::swap(here_, below_);
      std::fill(below_.begin(), below_.end(), Light{});
      // To and fro, so that errors do not drift to one side.
      for (std::size_t i = 0; i < count_; ++i) choose_one(first, row % 2 == 0 ? i : count_ - 1 - i, row % 2 == 0 ? 1 : -1);
    }
  }

  void choose_one(std::size_t first, std::size_t column, int ahead) {
    const std::size_t at = column + 1;  // errors have a place more at either end
    const Light light = dither_ ? cells_[first + column] + here_[at] : cells_[first + column];
    const Choice choice = choose(seen(light));
    if (whose_ != Whose::everybodys && (whose_ == Whose::sure) != (choice.margin >= kSettled)) return;
    picture_.cells[first + column] = static_cast<std::uint8_t>(choice.taken);
    ++picture_.used[choice.taken];
    if (picture_.colors[choice.wanted].stock != StockColor::kAny) margins_[choice.wanted].push_back(choice.margin);
    if (!dither_) return;
    const Light error = kCarried / 16.0 * (light - lights_[choice.taken]);
    const auto aside = [at](int step) { return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + step); };
    here_[aside(ahead)] = here_[aside(ahead)] + 7.0 * error;
    below_[aside(-ahead)] = below_[aside(-ahead)] + 3.0 * error;
    below_[at] = below_[at] + 5.0 * error;
    below_[aside(ahead)] = below_[aside(ahead)] + error;
  }

  Choice choose(const Seen& wish) const {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    double least = kNever, second = kNever, least_left = kNever;
    Choice choice;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (picture_.colors[i].stock == 0) continue;
      const double cost = squared_distance(wish, seen_[i]) + prices_[i];
      if (cost < least) {
        second = least;
        least = cost;
        choice.wanted = i;
      } else {
        second = std::min(second, cost);
      }
      if (cost < least_left && !(kept_ && picture_.used[i] == picture_.colors[i].stock)) {
        least_left = cost;
        choice.taken = i;
      }
    }
    choice.margin = second - least;
    return choice;
  }

  /// Whether any colour became dearer.
  bool raise_prices() {
    bool raised = false;
    for (std::size_t i = 0; i < prices_.size(); ++i) {
      const std::int64_t excess = std::ssize(margins_[i]) - picture_.colors[i].stock;
      if (excess <= 0) continue;
      const auto last = margins_[i].begin() + static_cast<std::ptrdiff_t>(excess - 1);
      std::nth_element(margins_[i].begin(), last, margins_[i].end());
      // Those who stay lose more: the price goes half-way to theirs. Errors answer to a price of themselves, so that it comes by and by.
      const double next = *std::min_element(last + 1, margins_[i].end());
      const bool alike = next - *last < kSettled;
      if (!dither_ && alike && *last < kSettled) continue;
      prices_[i] += dither_ ? 0.25 * *last + kStep : alike ? *last * kJustBelow : 0.5 * (*last + next);
      raised = true;
    }
    return raised;
  }

  const std::vector<Light>& cells_;
  bool dither_, kept_ = false;
  Whose whose_ = Whose::everybodys;
  Picture& picture_;
  std::size_t count_;
  std::vector<Light> here_, below_;  ///< Errors of the line and of the one below.
  std::vector<Light> lights_;        ///< Of the colours.
  std::vector<Seen> seen_;
  std::vector<double> prices_;                ///< OKLab squared.
  std::vector<std::vector<double>> margins_;  ///< Of those that want a colour.
};

}  // namespace

void choose_colors(const std::vector<Light>& cells, bool dither, Picture& picture) { Chooser(cells, dither, picture).choose(); }

}  // namespace topple
