// SPDX-License-Identifier: GPL-3.0-or-later
// Edits of a checkpoint whose checksum has been made right again: refused with a message, or restored.
#include "cases/readers/reader.hpp"
#include "cases/runs/recorder.hpp"
#include "post/file_output.hpp"
#include "post/files/checkpoint_file.hpp"
#include "tests/fuzz/target.hpp"

#include <fmt/format.h>

using namespace dielast;

namespace {

constexpr std::string_view text = R"toml([film]
material = "VHB 4910"
thickness = "1 mm"
[patch]
[drive]
voltage = "1 kV"
[[step]]
kind = "voltage"
duration = "1 s"
increments = 4
[[step]]
kind = "hold"
duration = "1 s"
increments = 4
)toml";

/// A case, its folder, and the content of the checkpoint in the middle of its run.
struct Interrupted {
  std::filesystem::path folder = fuzz::scratch() / "results";
  cases::Case one;
  std::string content;
  std::vector<std::string> names; ///< of the files that belong to it

  Interrupted() {
    fuzz::write(fuzz::scratch() / "case.toml", text);
    one = cases::read_case(fuzz::scratch() / "case.toml");
    cases::Simulation simulation(one, 1);
    post::ResultsFolder results(folder, "run");
    cases::Recorder recorder(one, simulation, results, false);
    int left = 7;
    simulation.run({.on_accept = [&](const cases::Frame& frame) {
      recorder.record(frame);
      return --left > 0;
    }});
    recorder.save_checkpoint();
    nlohmann::json::to_cbor(post::read_checkpoint(folder / "checkpoint.cbor"), content);
    names = results.names();
  }
};

} // namespace

/// Four bytes for each edit: a place (two bytes, in the part that they can reach), what to do there, a byte.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Interrupted run;
  std::string content = run.content;
  for (; size >= 4; data += 4, size -= 4) {
    const std::size_t at = (data[0] + 256u * data[1]) * content.size() / 65536;
    if (content.empty()) break;
    switch (data[2] % 4) {
    case 0:
      content[at] = static_cast<char>(content[at] ^ (1 << data[3] % 8));
      break;
    case 1:
      content[at] = static_cast<char>(data[3]);
      break;
    case 2:
      content.erase(at, data[3]);
      break;
    default:
      content.insert(at, content.substr(at, data[3]));
      break;
    }
  }
  const std::string head = fmt::format("dielast checkpoint {} {} {:016x}\n", post::checkpoint_format,
                                       content.size(), post::checksum(content));
  post::ResultsFolder results(run.folder, "run");
  results.begin(run.names); // the checkpoint before may have kept fewer
  for (const std::string& name : run.names)
    if (!std::filesystem::exists(results / name)) fuzz::write(results / name, "");
  fuzz::write(results / "checkpoint.cbor", head + content);
  try {
    cases::Simulation simulation(run.one, 1);
    const cases::Recorder recorder(run.one, simulation, results, true);
  } catch (const cases::FileError&) {
  } catch (const std::exception& error) {
    fuzz::fail(std::string("an error without a place: ") + error.what());
  }
  return 0;
}
