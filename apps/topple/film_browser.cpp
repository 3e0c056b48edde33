#include "film_browser.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

namespace topple::app {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> browser_names() {
  if (const char* chosen = std::getenv("TOPPLE_CHROMIUM"); chosen != nullptr && *chosen != '\0') return {chosen};
  return {"chromium", "chromium-browser", "google-chrome"};
}

std::vector<std::string> options_for(const fs::path& folder, const std::string& address) {
  std::vector<std::string> options = {"--headless=new", "--user-data-dir=" + folder.string(), "--no-first-run",
                                      "--disable-background-networking", "--disable-component-update", "--disable-sync",
                                      "--disable-background-timer-throttling", "--disable-renderer-backgrounding", "--mute-audio",
                                      // Where there is no graphics card the processor draws.
                                      "--enable-unsafe-swiftshader", address};
  // Chromium refuses its sandbox to root; what it shows here is this program's own page and nothing else.
  if (geteuid() == 0) options.insert(options.begin(), "--no-sandbox");
  return options;
}

/// -1 if there is no such program.
int spawn(const std::string& program, const std::vector<std::string>& options, const fs::path& log) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // So that all its processes can be ended at once.
  posix_spawnattr_setpgroup(&attributes, 0);
  std::vector<std::string> words = {program};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = -1;
  const int problem = posix_spawnp(&child, program.c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return problem == 0 ? child : -1;
}

}  // namespace

Result<FilmBrowser> FilmBrowser::start(const std::string& address) {
  std::string pattern = (fs::temp_directory_path() / "topple-render-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) return failure("No folder can be made in " + fs::temp_directory_path().string() + ".");
  FilmBrowser browser;
  browser.folder_ = pattern;
  for (const std::string& name : browser_names()) {
    browser.process_ = spawn(name, options_for(browser.folder_, address), browser.folder_ / "log");
    if (browser.process_ > 0) return browser;
  }
  return failure("Films are drawn by Chromium, and there is none: install the package chromium, or name the program in TOPPLE_CHROMIUM.");
}

FilmBrowser::FilmBrowser(FilmBrowser&& other) noexcept : process_(other.process_), folder_(std::move(other.folder_)) {
  other.process_ = -1;
  other.folder_.clear();
}

FilmBrowser::~FilmBrowser() {
  if (process_ > 0) {
    kill(-process_, SIGTERM);
    for (int i = 0; i < 50 && waitpid(process_, nullptr, WNOHANG) == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    kill(-process_, SIGKILL);
    waitpid(process_, nullptr, WNOHANG);
  }
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

bool FilmBrowser::running() {
  if (process_ > 0 && waitpid(process_, nullptr, WNOHANG) == process_) {
    kill(-process_, SIGKILL);
    process_ = -1;
  }
  return process_ > 0;
}

std::string FilmBrowser::last_words() const {
  constexpr std::size_t kMost = 600;
  std::ifstream stream(folder_ / "log");
  std::string words{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  return words.size() > kMost ? words.substr(words.size() - kMost) : words;
}

}  // namespace topple::app
