/// What is the same on every page: its style, its opening words, how verdicts are reached.
#pragma once

#include <string_view>

namespace topple::validation {

inline constexpr std::string_view kPageHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Topple: validation</title>
<style>
:root { --ink: #1c1c1c; --soft: #5c5c5c; --rule: #d9d9d9; }
body { margin: 0; color: var(--ink); background: #fff; font: 17px/1.5 "Source Serif 4", "Charter", "Georgia", serif; }
main { max-width: 46rem; margin: 0 auto; padding: 2.5rem 1.25rem 4rem; }
h1 { font-size: 2rem; line-height: 1.2; margin: 0 0 .5rem; font-weight: 600; }
h2 { font-size: 1.3rem; line-height: 1.3; margin: 3rem 0 .5rem; padding-top: 1rem; border-top: 1px solid var(--rule); font-weight: 600; }
p { margin: .5rem 0; }
.lead { font-size: 1.1rem; }
.source, small, footer { color: var(--soft); }
.source { font-size: .9rem; }
figure { margin: 1.25rem 0 1rem; break-inside: avoid; }
figure img { width: 100%; height: auto; display: block; }
figcaption { font-size: .92rem; line-height: 1.45; margin-top: .4rem; }
table { border-collapse: collapse; width: 100%; margin: .75rem 0; font: 14px/1.4 system-ui, "Helvetica Neue", Arial, sans-serif; border-top: 1.5px solid var(--ink); border-bottom: 1.5px solid var(--ink); }
th { text-align: left; font-weight: 600; border-bottom: 1px solid var(--ink); }
th, td { padding: .3rem .6rem .3rem 0; vertical-align: top; }
tbody tr + tr td { border-top: 1px solid #ececec; }
.verdict { white-space: nowrap; font-weight: 600; }
.agrees { color: #00694a; }
.some { color: #7a5200; }
.not { color: #9c3b00; }
summary { cursor: pointer; font: 600 14px/1.6 system-ui, "Helvetica Neue", Arial, sans-serif; color: var(--soft); }
a { color: #0a5a94; }
code { font-size: .9em; }
footer { margin-top: 3rem; font-size: .9rem; border-top: 1px solid var(--rule); padding-top: 1rem; }
@media (max-width: 40rem) {
  main { padding: 1.25rem .9rem 3rem; }
  table { display: block; overflow-x: auto; }
  .verdict { white-space: normal; }
}
@media print {
  body { font-size: 10pt; }
  main { max-width: none; padding: 0; }
  h2 { break-after: avoid; margin-top: 1.5rem; }
  table { font-size: 8pt; break-inside: avoid; }
  a { color: inherit; text-decoration: none; }
}
</style>
</head>
<body>
<main>
<h1>Does Topple fall the way dominoes do?</h1>
<p class="lead">Every published measurement of falling dominoes that we could find, beside what Topple's three models predict for the same bricks.
Where they disagree, it stays on this page.</p>
<p><b>hinge</b> lets every brick turn about its toe while all leaning bricks push together; <b>rigid</b> lets bricks slide, twist and bounce freely;
<b>pivot</b> is a student report's simple model, one brick at a time.</p>
)";

inline constexpr std::string_view kPageRules = R"(
<p><b>How a verdict is reached.</b> Published rows almost never state the friction of their bricks, so nothing is picked to fit: a source is run over the
plausible range of everything it leaves open (brick on brick 0.05 to 0.4, floor 0.2 to 0.9, restitution 0 to 0.6).
<span class="verdict agrees">● agrees</span>: with the default surfaces (0.2, 0.5, 0) every point is inside its error bar.
<span class="verdict some">◐ agrees for some plausible friction</span>: one choice out of the ranges is inside every error bar of that source.
<span class="verdict not">○ does not agree</span>: no choice is. Where nothing is left open, only the first and the last can be.
In the figures black marks are published numbers, bands are the whole plausible range, and lines the default surfaces.</p>
)";

}  // namespace topple::validation
