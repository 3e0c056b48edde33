// The work: reads the sources, runs on several threads what is not kept yet, judges.
#include "topple/validation.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "validation/judge.h"
#include "validation/kept.h"
#include "validation/page.h"

namespace topple {

using namespace validation;

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kLook{100};  // How often the caller is told, and asked whether to go on.

/// A run that is wanted, by the name under which it is kept.
struct Wanted {
  std::string name;
  Planned planned;
};

/// What the threads share.
struct Shared {
  std::mutex mutex;
  std::condition_variable finished;
  std::size_t next = 0;
  std::size_t done = 0;
  std::size_t running = 0;
  std::atomic<bool> stop = false;
  std::string error;
};

Result<std::vector<fs::path>> folders_of(const ValidationConfig& config) {
  std::error_code problem;
  std::vector<fs::path> folders;
  for (fs::directory_iterator it(config.cases, problem), end; !problem && it != end; it.increment(problem)) {
    if (it->is_directory() && fs::exists(it->path() / "source.toml")) folders.push_back(it->path());
  }
  if (problem || folders.empty()) return failure(config.cases.string() + " holds no folder with a source.toml.");
  std::sort(folders.begin(), folders.end());
  if (config.names.empty()) return folders;
  std::vector<fs::path> chosen;
  std::string known;
  for (const fs::path& folder : folders) {
    if (!known.empty()) known += ", ";
    known += folder.filename().string();
    if (std::find(config.names.begin(), config.names.end(), folder.filename().string()) != config.names.end()) chosen.push_back(folder);
  }
  for (const std::string& name : config.names) {
    const bool there = std::any_of(chosen.begin(), chosen.end(), [&](const fs::path& folder) { return folder.filename() == name; });
    if (!there) return failure("There is no source \"" + name + std::string("\"; there are ").append(known) + ".");
  }
  return chosen;
}

}  // namespace

const char* words_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::agrees:
      return "agrees";
    case Verdict::agrees_for_some:
      return "agrees for some plausible friction";
    case Verdict::does_not_agree:
      break;
  }
  return "does not agree";
}

struct Validation::State {
  ValidationConfig config;
  std::vector<Source> sources;
  KeptRuns kept;
  std::map<std::string, std::uint64_t> fingerprints;  // By model.
  std::vector<Judged> judged;
  std::vector<SourceReport> reports;

  bool wanted(const Series& series) const { return series.quick || !config.quick; }
  Result<std::string> name_of(const Planned& planned);
  Result<std::vector<Wanted>> missing();
  void work(const std::vector<Wanted>& jobs, Shared& shared);
  bool all_run(const std::vector<Wanted>& jobs, const Watch& watch, std::string& error);
  void judge();
};

Result<std::string> Validation::State::name_of(const Planned& planned) {
  if (!fingerprints.contains(planned.model)) {
    const Result<std::uint64_t> print = fingerprint(planned.model);
    if (!print) return std::unexpected(print.error());
    fingerprints[planned.model] = *print;
  }
  return KeptRuns::name(planned.model, fingerprints[planned.model], planned.job);
}

/// Every run that some series needs and that is not kept, once.
Result<std::vector<Wanted>> Validation::State::missing() {
  std::map<std::string, bool> seen;
  std::vector<Wanted> jobs;
  for (const Source& source : sources) {
    for (const Series& series : source.series) {
      if (!wanted(series)) continue;
      for (Planned& planned : plan(series)) {
        Result<std::string> name = name_of(planned);
        if (!name) return std::unexpected(name.error());
        if (!kept.find(*name) && !std::exchange(seen[*name], true)) jobs.push_back({std::move(*name), std::move(planned)});
      }
    }
  }
  return jobs;
}

void Validation::State::work(const std::vector<Wanted>& jobs, Shared& shared) {
  std::unique_lock lock(shared.mutex);
  while (shared.next < jobs.size() && !shared.stop) {
    const Wanted& job = jobs[shared.next++];
    lock.unlock();
    const Result<Outcome> outcome = run_job(job.planned.job, [&shared] { return shared.stop.load(); });
    lock.lock();
    if (outcome) {
      kept.add(job.name, *outcome);
      ++shared.done;
    } else {
      if (shared.error.empty()) shared.error = outcome.error().message;
      shared.stop = true;
    }
  }
  --shared.running;
  shared.finished.notify_all();
}

bool Validation::State::all_run(const std::vector<Wanted>& jobs, const Watch& watch, std::string& error) {
  Shared shared;
  shared.running = static_cast<std::size_t>(std::max(1, config.threads));
  std::vector<std::thread> threads;
  for (std::size_t i = shared.running; i > 0; --i) threads.emplace_back([this, &jobs, &shared] { work(jobs, shared); });
  std::unique_lock lock(shared.mutex);
  bool working = true;
  while (working) {
    shared.finished.wait_for(lock, kLook, [&shared] { return shared.running == 0; });
    working = shared.running > 0;
    const std::size_t done = shared.done;
    lock.unlock();
    if (watch && !watch(done, jobs.size())) shared.stop = true;
    lock.lock();
  }
  lock.unlock();
  for (std::thread& thread : threads) thread.join();
  error = shared.error;
  return shared.done == jobs.size();
}

void Validation::State::judge() {
  judged.clear();
  reports.clear();
  for (const Source& source : sources) {
    Judged one{.source = &source, .predictions = {}, .comparisons = {}};
    for (const Series& series : source.series) {
      if (!wanted(series)) {
        one.predictions.emplace_back();
        continue;
      }
      std::vector<Outcome> outcomes;
      for (const Planned& planned : plan(series)) outcomes.push_back(*kept.find(*name_of(planned)));
      std::vector<const Outcome*> pointers;
      pointers.reserve(outcomes.size());
      for (const Outcome& outcome : outcomes) pointers.push_back(&outcome);
      one.predictions.push_back(gather(series, pointers));
    }
    one.comparisons = compare_all(one);
    reports.push_back({source.name, source.title, source.kind, one.comparisons, check_claims(one)});
    judged.push_back(std::move(one));
  }
}

Validation::Validation() : state_(std::make_unique<State>()) {}
Validation::~Validation() = default;
Validation::Validation(Validation&&) noexcept = default;
Validation& Validation::operator=(Validation&&) noexcept = default;

Result<Validation> Validation::open(const ValidationConfig& config) {
  Validation validation;
  State& state = *validation.state_;
  state.config = config;
  const Result<std::vector<fs::path>> folders = folders_of(config);
  if (!folders) return std::unexpected(folders.error());
  std::string problems;
  for (const fs::path& folder : *folders) {
    Result<Source> source = read_source(folder);
    if (source) {
      state.sources.push_back(std::move(*source));
    } else {
      problems += (problems.empty() ? "" : "\n") + source.error().message;
    }
  }
  if (!problems.empty()) return failure(problems);
  std::stable_sort(state.sources.begin(), state.sources.end(), [](const Source& a, const Source& b) { return a.order < b.order; });
  Result<KeptRuns> kept = KeptRuns::open(config.kept, config.fresh);
  if (!kept) return std::unexpected(kept.error());
  state.kept = std::move(*kept);
  return validation;
}

Result<bool> Validation::run(const Watch& watch) {
  const Result<std::vector<Wanted>> jobs = state_->missing();
  if (!jobs) return std::unexpected(jobs.error());
  std::string error;
  if (!state_->all_run(*jobs, watch, error)) {
    if (!error.empty()) return failure(error);
    return false;
  }
  state_->judge();
  return true;
}

const std::string& Validation::not_kept() const { return state_->kept.problem(); }

std::span<const SourceReport> Validation::reports() const { return state_->reports; }

Result<void> Validation::write_page(const fs::path& folder) const {
  return validation::write_page(state_->judged, state_->reports, folder);
}

}  // namespace topple
