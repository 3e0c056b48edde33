#include "validation/page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "export/gnuplot.h"
#include "topple/export.h"
#include "validation/figure.h"
#include "validation/page_style.h"

namespace topple::validation {
namespace {

namespace fs = std::filesystem;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += letter;
    }
  }
  return out;
}

/// Blank lines part paragraphs.
std::string paragraphs(const std::string& text, const std::string& lead = {}) {
  std::string out;
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t gap = text.find("\n\n", from);
    const std::string one = text.substr(from, gap == std::string::npos ? std::string::npos : gap - from);
    if (one.find_first_not_of(" \n") != std::string::npos) {
      out += "<p>" + (out.empty() && !lead.empty() ? "<b>" + lead + "</b> " : std::string()) + escaped(one) + "</p>\n";
    }
    from = gap == std::string::npos ? text.size() : gap + 2;
  }
  return out;
}

const char* class_of(Verdict verdict) {
  constexpr std::array<const char*, 3> kClasses = {"agrees", "some", "not"};
  return kClasses[static_cast<std::size_t>(verdict)];
}

const char* mark_of(Verdict verdict) {
  constexpr std::array<const char*, 3> kMarks = {"●", "◐", "○"};
  return kMarks[static_cast<std::size_t>(verdict)];
}

std::string badge(Verdict verdict) {
  return std::string("<span class=\"verdict ") + class_of(verdict) + "\">" + mark_of(verdict) + " " + words_of(verdict) + "</span>";
}

/// A table of `head` and rows; cells are HTML already.
std::string table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<table>\n<thead><tr>";
  for (const std::string& cell : head) out += "<th>" + cell + "</th>";
  out += "</tr></thead>\n<tbody>\n";
  for (const auto& row : rows) {
    out += "<tr>";
    for (const std::string& cell : row) out += "<td>" + cell + "</td>";
    out += "</tr>\n";
  }
  return out + "</tbody></table>\n";
}

std::string comparison_table(const SourceReport& report) {
  std::vector<std::vector<std::string>> rows;
  for (const Comparison& one : report.comparisons) {
    const std::string name = escaped(one.name) + (one.reading.empty() ? "" : ", " + escaped(one.reading));
    rows.push_back(
        {name, badge(one.verdict), escaped(one.words.substr(std::string(words_of(one.verdict)).size() + 2)), escaped(one.point_fits)});
  }
  if (rows.empty()) return {};
  const bool fits =
      std::any_of(report.comparisons.begin(), report.comparisons.end(), [](const Comparison& c) { return !c.point_fits.empty(); });
  if (!fits) {
    for (auto& row : rows) row.pop_back();
  }
  std::vector<std::string> head = {"Compared", "Verdict", "How far"};
  if (fits) head.emplace_back("Friction that fits each point alone");
  return table(head, rows);
}

std::string claim_table(const SourceReport& report) {
  std::vector<std::vector<std::string>> rows;
  rows.reserve(report.claims.size());
  for (const ClaimCheck& claim : report.claims) {
    rows.push_back({claim.holds ? "✓" : "✗", escaped(claim.name), escaped(claim.found), escaped(claim.why)});
  }
  if (rows.empty()) return {};
  return "<details open><summary>What we claim, and whether it holds</summary>\n" +
         table({"", "Claim", "Found", "Why this tolerance"}, rows) + "</details>\n";
}

std::string points_table(const Source& source) {
  std::vector<std::vector<std::string>> rows;
  for (const Points& points : source.points) {
    std::string list;
    for (std::size_t i = 0; i < points.x.size() && !points.line; ++i) {
      list += (i == 0 ? "" : "; ") + rounded(points.x[i], 5) + ": " + rounded(points.y[i], 4);
      if (points.error[i] > 0.0) list += " ± " + rounded(points.error[i], 2);
    }
    if (!list.empty()) rows.push_back({escaped(points.name), list, escaped(points.solidity.empty() ? source.solidity : points.solidity)});
  }
  if (rows.empty() || source.figure.empty()) return {};
  return "<details><summary>The published numbers (" + escaped(source.figure[0].x_label) + ": " + escaped(source.figure[0].y_label) +
         ")</summary>\n" + table({"Points", "Numbers", "How solid"}, rows) + "</details>\n";
}

Result<std::string> section(const Judged& judged, const SourceReport& report, int number, const fs::path& folder) {
  const Source& source = *judged.source;
  std::string out =
      "<section id=\"" + escaped(source.name) + "\">\n<h2>" + std::to_string(number) + ". " + escaped(source.title) + "</h2>\n";
  std::string keys;
  for (const std::string& key : source.references) keys += (keys.empty() ? "" : ", ") + escaped(key);
  out += "<p class=\"source\">" + (keys.empty() ? std::string() : "Source: " + keys + ". ") + "How solid: " + escaped(source.solidity) +
         ".</p>\n";
  out += paragraphs(source.states, "What is stated.") + paragraphs(source.does_not_state, "What is not.") +
         paragraphs(source.inputs, "What we run.");
  if (!source.figure.empty()) {
    const std::string file = "figures/" + source.name + ".svg";
    if (auto drawn = draw_figure(judged, folder / file); !drawn) return std::unexpected(drawn.error());
    const Result<std::string> caption = filled(source.figure[0].caption, judged);
    if (!caption) return std::unexpected(caption.error());
    out += "<figure><img src=\"" + file + "\" alt=\"" + escaped(source.title) + "\"><figcaption><b>Figure " + std::to_string(number) +
           ".</b> " + escaped(*caption) + "</figcaption></figure>\n";
  }
  const Result<std::string> conclusion = filled(source.conclusion, judged);
  if (!conclusion) return std::unexpected(conclusion.error());
  out += comparison_table(report) + paragraphs(*conclusion) + claim_table(report) + points_table(source);
  return out + "</section>\n";
}

/// Each verdict once, with all that it was given to.
std::string grouped_verdicts(const SourceReport& report) {
  std::string out;
  for (const Verdict verdict : {Verdict::agrees, Verdict::agrees_for_some, Verdict::does_not_agree}) {
    std::string names;
    for (const Comparison& one : report.comparisons) {
      if (one.verdict == verdict)
        names += (names.empty() ? "" : "; ") + escaped(one.name + (one.reading.empty() ? "" : ", " + one.reading));
    }
    if (!names.empty()) out += (out.empty() ? "" : "<br>") + badge(verdict) + "<br><small>" + names + "</small>";
  }
  return out;
}

std::string overview(std::span<const SourceReport> reports) {
  std::vector<std::vector<std::string>> rows;
  int number = 0;
  for (const SourceReport& report : reports) {
    ++number;
    const std::string verdicts = grouped_verdicts(report);
    const auto holding = std::count_if(report.claims.begin(), report.claims.end(), [](const ClaimCheck& claim) { return claim.holds; });
    rows.push_back({std::to_string(number), "<a href=\"#" + escaped(report.name) + "\">" + escaped(report.title) + "</a>",
                    !verdicts.empty()        ? verdicts
                    : report.kind == "study" ? "a study"
                                             : "by its claims",
                    report.claims.empty() ? "" : std::to_string(holding) + " of " + std::to_string(report.claims.size())});
  }
  return table({"", "Source", "Verdicts", "Claims that hold"}, rows);
}

}  // namespace

Result<void> write_page(std::span<const Judged> all, std::span<const SourceReport> reports, const fs::path& folder) {
  std::error_code problem;
  fs::create_directories(folder / "figures", problem);
  if (problem) return failure("The page cannot be written to " + folder.string() + ": " + problem.message() + ".");
  std::string page = std::string(kPageHead) + overview(reports) + std::string(kPageRules);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Result<std::string> part = section(all[i], reports[i], static_cast<int>(i) + 1, folder);
    if (!part) return std::unexpected(part.error());
    page += *part;
  }
  page += "<footer>Written by <code>topple validate --html</code>, Topple " + std::string(TOPPLE_VERSION) +
          ". Every number and figure on this page comes from that command.</footer>\n</main>\n</body>\n</html>\n";
  return save_bytes(page, folder / "index.html");
}

}  // namespace topple::validation
