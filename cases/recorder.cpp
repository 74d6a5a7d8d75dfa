#include "cases/recorder.hpp"

#include "cases/quantities.hpp"
#include "cases/resolved.hpp"
#include "post/checkpoint.hpp"
#include "post/file_output.hpp"
#include "post/reductions.hpp"

#include <algorithm>
#include <fstream>

namespace dielast::cases {

using nlohmann::json;

namespace {

/// Shorter runs are repeated faster than their checkpoints are written.
constexpr std::chrono::seconds checkpoint_interval{2};

json archive(const post::StepRecord& record) {
  json events = json::array();
  for (const post::Event& event : record.events) events.push_back({event.kind, event.place, event.message});
  return {{"index", record.index},
          {"step", record.step},
          {"load_factor", record.load_factor},
          {"voltages", record.voltages},
          {"iterations", record.iterations},
          {"residual", record.residual},
          {"negative_pivots", record.negative_pivots},
          {"events", std::move(events)}};
}

post::StepRecord restore_record(const json& archived) {
  post::StepRecord record{archived.at("index"),           archived.at("step"),
                          archived.at("load_factor"),     archived.at("voltages"),
                          archived.at("iterations"),      archived.at("residual"),
                          archived.at("negative_pivots"), {}};
  for (const json& event : archived.at("events"))
    record.events.push_back({event.at(0), event.at(1), event.at(2)});
  return record;
}

json archive(const Snapshot& snapshot) {
  return {
      {"title", snapshot.title},
      {"voltage", snapshot.voltage},
      {"displacement", post::pack({snapshot.displacement.front().data(), 3 * snapshot.displacement.size()})},
      {"thickness", post::pack(snapshot.thickness)},
      {"field", post::pack(snapshot.field)}};
}

Snapshot restore_snapshot(const json& archived) {
  Snapshot snapshot{archived.at("title"),
                    archived.at("voltage"),
                    {},
                    post::unpack(archived.at("thickness")),
                    post::unpack(archived.at("field"))};
  const std::vector<double> displacement = post::unpack(archived.at("displacement"));
  for (std::size_t i = 0; i + 2 < displacement.size(); i += 3)
    snapshot.displacement.emplace_back(&displacement[i]);
  return snapshot;
}

} // namespace

std::vector<post::Column> history_columns(const Case& one) {
  std::vector<post::Column> columns{{"load_factor", "1"}};
  for (const Electrode& electrode : one.electrodes)
    columns.push_back({one.electrodes.size() == 1 ? "voltage" : "voltage_" + electrode.name, "V"});
  for (const Quantity& quantity : one.quantities) columns.push_back({quantity.name, unit_of(quantity)});
  for (const char* solver : {"iterations", "residual", "negative_pivots"}) columns.push_back({solver, "1"});
  return columns;
}

Recorder::Recorder(const Case& one, Simulation& simulation, std::filesystem::path directory, bool resume)
    : case_(one), simulation_(simulation), directory_(std::move(directory)),
      fingerprint_(resolved_text(one)) {
  if (resume) restore_checkpoint();
  const int kept = static_cast<int>(journal_.records.size());
  post::replace_file(directory_ / "resolved.toml", fingerprint_);
  history_.emplace(directory_ / "history.csv", history_columns(one), kept);
  if (one.fields) series_.emplace(directory_, one.source.stem().string(), simulation.device().mesh, kept);
}

void Recorder::record(const Frame& frame) {
  const post::StepRecord& record = frame.record;
  std::vector<double> row{record.load_factor};
  row.insert(row.end(), record.voltages.begin(), record.voltages.end());
  row.insert(row.end(), frame.values.begin(), frame.values.end());
  for (const double number : {double(record.iterations), record.residual, double(record.negative_pivots)})
    row.push_back(number);
  history_->append(record.step, row);
  if (series_)
    series_->write(steps_ended_ + record.load_factor, record.step, frame.measured.state.displacement,
                   frame.measured.samples);

  const Device& device = simulation_.device();
  const int triangles = device.mesh.triangles()->size();
  Snapshot snapshot{record.step, record.largest_voltage(), frame.measured.state.displacement,
                    post::average(frame.measured.samples, "thickness", triangles),
                    post::average(frame.measured.samples, "electric_field", triangles)};
  // The last accepted state is replaced until its step has ended.
  const bool replaces = record.index > 1 && journal_.records.back().step == record.step;
  if (replaces)
    journal_.snapshots.back() = std::move(snapshot);
  else
    journal_.snapshots.push_back(std::move(snapshot));
  journal_.records.push_back(record);
  journal_.values.push_back(frame.values);
  steps_ended_ += frame.ends_step;
  if (std::chrono::steady_clock::now() - saved_ > checkpoint_interval) save_checkpoint();
}

void Recorder::save_checkpoint() {
  const SimulationProgress progress = simulation_.progress();
  json records = json::array(), values = json::array(), snapshots = json::array();
  for (const auto& record : journal_.records) records.push_back(archive(record));
  for (const auto& row : journal_.values) values.push_back(post::pack(row));
  for (const auto& snapshot : journal_.snapshots) snapshots.push_back(archive(snapshot));
  const std::vector<std::uint8_t> bytes =
      json::to_cbor({{"case", fingerprint_},
                     {"step", progress.step},
                     {"records", progress.records},
                     {"ramp", post::archive(progress.ramp)},
                     {"rest_lengths", progress.rest_lengths},
                     {"active_events", progress.active_events},
                     {"results", post::pack(simulation_.results())},
                     {"steps_ended", steps_ended_},
                     {"journal", {{"records", records}, {"values", values}, {"snapshots", snapshots}}}});
  post::replace_file(checkpoint_path(), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  saved_ = std::chrono::steady_clock::now();
}

void Recorder::remove_checkpoint() { std::filesystem::remove(checkpoint_path()); }

void Recorder::restore_checkpoint() {
  std::ifstream file(checkpoint_path(), std::ios::binary);
  if (!file) return; // stopped before the first checkpoint: nothing is lost by starting over
  try {
    const json saved = json::from_cbor(file);
    if (saved.at("case") != fingerprint_)
      throw FileError(checkpoint_path().string() +
                      ": the case has changed since; run it again without --resume");
    const Device& device = simulation_.device();
    simulation_.resume({saved.at("step"), saved.at("records"),
                        post::restore(saved.at("ramp"), device.mesh.nodes.size(),
                                      static_cast<std::size_t>(device.model.dofs.count())),
                        saved.at("rest_lengths"), saved.at("active_events")});
    simulation_.set_results(post::unpack(saved.at("results")));
    steps_ended_ = saved.at("steps_ended");
    const json& journal = saved.at("journal");
    for (const json& record : journal.at("records")) journal_.records.push_back(restore_record(record));
    for (const json& row : journal.at("values")) journal_.values.push_back(post::unpack(row));
    for (const json& snapshot : journal.at("snapshots"))
      journal_.snapshots.push_back(restore_snapshot(snapshot));
  } catch (const json::exception&) {
    throw FileError(checkpoint_path().string() + ": not a checkpoint; run again without --resume");
  }
}

} // namespace dielast::cases
