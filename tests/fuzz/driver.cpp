// SPDX-License-Identifier: GPL-3.0-or-later
// A fuzzer for every compiler: feeds a target with mutations of a corpus, from a fixed seed, for a stated
// time.
//   fuzz_reader [--seconds 5] [--seed 1] [--runs N] FILE|FOLDER...
// Without --seconds the environment's DIELAST_FUZZ_SECONDS counts. The input being tried stands in
// <program>.input in the working directory: after a crash or a hang it is the one to look at, and to add to
// the corpus. Where the compiler has libFuzzer, its own driver takes the place of this one.
#include <sys/time.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

constexpr std::size_t longest = 1 << 16; ///< bytes of an input
constexpr unsigned longest_run = 60;     ///< s of the processor; what takes longer hangs
constexpr unsigned longest_wait = 600;   ///< s

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t end) { return end == 0 ? 0 : random() % end; }

/// Words, numbers and texts in quotes of the corpus, and numbers at the ends of their ranges.
std::vector<std::string> tokens_of(const std::vector<std::string>& corpus) {
  std::vector<std::string> tokens{"0",     "-0",   "-0.0", "-1",    "1e308",     "1e-308", "1e-300",
                                  "1e300", "nan",  "inf",  "1e999", "[",         "]",      "{",
                                  "}",     "=",    "\"",   ".",     ",",         "\n",     "[[",
                                  "\"-",   " %\"", "true", "\xff",  "2147483648"};
  for (const std::string& text : corpus)
    for (std::size_t i = 0; i < text.size();) {
      const bool quoted = text[i] == '"';
      std::size_t end = quoted ? text.find_first_of("\"\n", i + 1) : text.find_first_of(" \t\r\n=,[]{}\"", i);
      end = std::min(end, text.size() - 1) + (quoted ? 1 : 0);
      if (end > i && end - i < 60) tokens.push_back(text.substr(i, end - i));
      i = std::max(end, i + 1);
    }
  return tokens;
}

/// The place of a line that `at` lies in: its first byte and the one behind its end.
std::pair<std::size_t, std::size_t> line_around(const std::string& text, std::size_t at) {
  const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  const std::size_t end = text.find('\n', at);
  return {before == std::string::npos ? 0 : before + 1, end == std::string::npos ? text.size() : end + 1};
}

void mutate(std::string& text, Random& random, const std::vector<std::string>& corpus,
            const std::vector<std::string>& tokens) {
  const std::size_t at = below(random, text.size() + 1);
  const std::string& other = corpus[below(random, corpus.size())];
  const auto [begin, end] = line_around(text, at);
  const auto [from, to] = line_around(other, below(random, other.size() + 1));
  const std::string& token = tokens[below(random, tokens.size())];
  switch (below(random, 10)) {
  case 0:
    if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(random, 8)));
    break;
  case 1:
    if (at < text.size()) text[at] = static_cast<char>(random());
    break;
  case 2:
    text.erase(at, 1 + below(random, 8));
    break;
  case 3:
    text.insert(at, token);
    break;
  case 4: { // a word instead of another
    const std::size_t word = std::min(text.find_first_not_of(" \t\n=,[]{}", at), text.size());
    const std::size_t stop = text.find_first_of(" \t\n=,[]{}", word);
    text.replace(word, (stop == std::string::npos ? text.size() : stop) - word, token);
    break;
  }
  case 5:
    text.erase(begin, end - begin);
    break;
  case 6:
    text.insert(begin, text.substr(begin, end - begin));
    break;
  case 7:
    text.insert(begin, other.substr(from, to - from));
    break;
  case 8:
    text.replace(begin, end - begin, other.substr(from, to - from));
    break;
  default: // the head of one and the tail of another
    text = text.substr(0, begin) + other.substr(from);
    break;
  }
  if (text.size() > longest) text.resize(longest);
}

std::vector<std::string> read_corpus(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::string> corpus;
  const auto add = [&](const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    if (corpus.back().size() > longest) corpus.back().resize(longest);
  };
  for (const auto& path : paths) {
    if (!std::filesystem::is_directory(path)) add(path);
    if (std::filesystem::is_directory(path))
      for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
        if (entry.is_regular_file()) add(entry.path());
  }
  if (corpus.empty()) corpus.emplace_back();
  return corpus;
}

/// Keeps the input that is being tried in a file, which outlives the process.
class LastInput {
 public:
  explicit LastInput(const std::string& path)
      : file_(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)) {}
  void keep(const std::string& text) const {
    if (pwrite(file_, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()) ||
        ftruncate(file_, static_cast<off_t>(text.size())) != 0)
      std::abort();
  }

 private:
  int file_;
};

} // namespace

int main(int argc, char** argv) {
  const char* const given = std::getenv("DIELAST_FUZZ_SECONDS");
  double seconds = given ? std::atof(given) : 5;
  unsigned long seed = 1, most = ~0UL;
  std::vector<std::filesystem::path> paths;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool takes_value = i + 1 < argc;
    if (word == "--seconds" && takes_value)
      seconds = std::atof(argv[++i]);
    else if (word == "--seed" && takes_value)
      seed = std::strtoul(argv[++i], nullptr, 10);
    else if (word == "--runs" && takes_value)
      most = std::strtoul(argv[++i], nullptr, 10);
    else
      paths.emplace_back(word);
  }
  const std::string name = std::filesystem::path(argv[0]).filename();
  const std::vector<std::string> corpus = read_corpus(paths), tokens = tokens_of(corpus);
  const LastInput last(name + ".input");
  Random random(seed);
  for (const int timer : {SIGALRM, SIGPROF})
    std::signal(timer, [](int) {
      constexpr char message[] = "hangs\n";
      [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, message, sizeof message - 1);
      std::abort();
    });
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  unsigned long runs = 0;
  for (; runs < most && (runs < corpus.size() || elapsed() < seconds); ++runs) {
    std::string text = corpus[runs < corpus.size() ? runs : below(random, corpus.size())];
    if (runs >= corpus.size()) // the corpus itself comes first
      for (std::size_t n = 1 + below(random, 6); n > 0; --n) mutate(text, random, corpus, tokens);
    last.keep(text);
    alarm(longest_wait);
    const itimerval processor{{}, {longest_run, 0}};
    setitimer(ITIMER_PROF, &processor, nullptr);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  }
  std::signal(SIGPROF, SIG_IGN);
  alarm(0);
  std::printf("%s: %lu executions in %.1f s, %zu inputs in the corpus, seed %lu\n", name.c_str(), runs,
              elapsed(), corpus.size(), seed);
  return 0;
}
