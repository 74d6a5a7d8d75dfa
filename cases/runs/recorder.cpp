// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/runs/recorder.hpp"

#include "cases/case/quantities.hpp"
#include "cases/readers/resolved.hpp"
#include "fem/algebra/kept_factor.hpp"
#include "post/engineering.hpp"
#include "post/reductions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace dielast::cases {

using nlohmann::json;

ShapeField shape_field(const Device& device) {
  if (device.solid) return {"principal_stretches.lambda1", "Largest stretch", "1"};
  return {"thickness", "Film thickness", "m"};
}

post::SeriesModel series_model(const Case& one, const Device& device) {
  post::SeriesModel model{device.mesh,       device.bars.widths, device.bars.heights,
                          device.film_parts, device.bars.parts,  {}};
  for (const Part& part : one.parts) model.parts.push_back(part.name.empty() ? "unnamed" : part.name);
  for (const FinPoints& fin : device.fins) model.fins.push_back(fin.corners);
  return model;
}

namespace {

/// Shorter runs are repeated faster than their checkpoints are written; these take a 30th of a run at most.
constexpr std::chrono::seconds checkpoint_interval{2};

json archive(const post::StepRecord& record) {
  json events = json::array();
  for (const post::Event& event : record.events) events.push_back(cases::archive(event));
  return {{"index", record.index},
          {"step", record.step},
          {"load_factor", record.load_factor},
          {"time", record.time},
          {"voltages", record.voltages},
          {"iterations", record.iterations},
          {"residual", record.residual},
          {"unstable_modes", record.unstable_modes},
          {"events", std::move(events)},
          {"jumped", record.jumped}};
}

post::StepRecord restore_record(const json& archived) {
  post::StepRecord record{archived.at("index"),    archived.at("step"),           archived.at("load_factor"),
                          archived.at("time"),     archived.at("voltages"),       archived.at("iterations"),
                          archived.at("residual"), archived.at("unstable_modes"), {}};
  for (const json& event : archived.at("events")) record.events.push_back(restore_event(event));
  record.jumped = archived.at("jumped");
  return record;
}

json archive(const Snapshot& snapshot) {
  return {
      {"title", snapshot.title},
      {"voltage", snapshot.voltage},
      {"displacement", post::pack({snapshot.displacement.front().data(), 3 * snapshot.displacement.size()})},
      {"shape", post::pack(snapshot.shape)},
      {"field", post::pack(snapshot.field)}};
}

Snapshot restore_snapshot(const json& archived, const meshing::Mesh& mesh) {
  const auto triangles = static_cast<std::size_t>(mesh.film()->size());
  Snapshot snapshot{archived.at("title"),
                    archived.at("voltage"),
                    {},
                    post::unpack(archived.at("shape"), triangles),
                    post::unpack(archived.at("field"), triangles)};
  const std::vector<double> displacement = post::unpack(archived.at("displacement"), 3 * mesh.nodes.size());
  for (std::size_t i = 0; i + 2 < displacement.size(); i += 3)
    snapshot.displacement.emplace_back(&displacement[i]);
  return snapshot;
}

constexpr std::size_t most_stills = 16; ///< of the states along the way in the report
constexpr double mode_drawn = 0.1;      ///< of the device's extent: how far its largest displacement goes
constexpr std::size_t most_shapes = 6;  ///< of vibrations in the report

Snapshot snapshot(const Device& device, const std::string& title, const fem::State& state,
                  const fem::Samples& samples) {
  double voltage = 0;
  for (std::size_t p = 0; p < device.model.ports.size(); ++p)
    if (device.model.ports[p].is_electrode() && std::abs(state.voltage[p]) > std::abs(voltage))
      voltage = state.voltage[p];
  const int cells = device.mesh.film()->size();
  return {title, voltage, state.displacement, post::average(samples, shape_field(device).name, cells),
          post::largest_average(samples, "electric_field", cells)};
}

/// A state displaced along a mode so far that the mode is seen.
Snapshot displaced(Snapshot at, const std::string& title, const std::vector<Eigen::Vector3d>& mode,
                   double extent) {
  at.title = title;
  double largest = 0;
  for (const Eigen::Vector3d& u : mode) largest = std::max(largest, u.norm());
  if (largest > 0)
    for (std::size_t n = 0; n < at.displacement.size() && n < mode.size(); ++n)
      at.displacement[n] += mode_drawn * extent / largest * mode[n];
  return at;
}

json archive(const Analysis& analysis) {
  json rows = json::array();
  for (const auto& row : analysis.rows) rows.push_back(post::pack(row));
  return {{"kind", analysis.kind},     {"step", analysis.step},       {"of", analysis.of},
          {"driven", analysis.driven}, {"columns", analysis.columns}, {"rows", std::move(rows)}};
}

Analysis restore_analysis(const json& archived) {
  Analysis analysis{archived.at("kind"),   archived.at("step"),    archived.at("of"),
                    archived.at("driven"), archived.at("columns"), {}};
  for (const json& row : archived.at("rows"))
    analysis.rows.push_back(post::unpack(row, analysis.columns.size()));
  return analysis;
}

/// A sum of time steps as it is meant: 5 s, not 4.999999999999998 s.
double without_rounding(double time) { return std::stod(fmt::format("{:.14g}", time)); }

std::vector<double> history_row(const post::StepRecord& record, const std::vector<double>& quantities) {
  std::vector<double> row{record.load_factor, without_rounding(record.time)};
  row.insert(row.end(), record.voltages.begin(), record.voltages.end());
  row.insert(row.end(), quantities.begin(), quantities.end());
  for (const double number :
       {double(record.iterations), record.residual, double(record.unstable_modes), double(record.jumped)})
    row.push_back(number);
  return row;
}

std::string table_name(std::string_view of) { return fmt::format("{}.csv", of); }

json archive(const post::SeriesStep& step, const fem::State& state) {
  json names = json::array();
  std::vector<double> values{step.time, step.load_factor};
  for (const auto& number : step.numbers) names.push_back(number.name), values.push_back(number.value);
  return {
      {"name", step.name}, {"names", names}, {"values", post::pack(values)}, {"state", post::archive(state)}};
}

post::SeriesStep restore_series_step(const json& archived) {
  const json& names = archived.at("names");
  const std::vector<double> values = post::unpack(archived.at("values"), names.size() + 2);
  post::SeriesStep step{values[0], archived.at("name"), values[1]};
  for (std::size_t n = 0; n < names.size(); ++n) step.numbers.push_back({names[n], values[n + 2]});
  return step;
}

} // namespace

Recorder::Recorder(const Case& one, Simulation& simulation, post::ResultsFolder& folder, bool resume)
    : case_(one), simulation_(simulation), folder_(folder), fingerprint_(resolved_text(one)) {
  next_checkpoint_ = std::chrono::steady_clock::now() + checkpoint_interval;
  if (resume) restore_checkpoint();
  folder_.write(resolved_name, fingerprint_);
  folder_.add(checkpoint_name);
  folder_.add(table_name(history_name));
  history_.emplace(folder_ / table_name(history_name), history_columns(one));
  for (std::size_t r = 0; r < journal_.records.size(); ++r)
    history_->append(journal_.records[r].step, history_row(journal_.records[r], journal_.values[r]));
  if (one.fields && !series_) open_series(series_, "");
}

std::string Recorder::series_name(std::string_view part) const {
  return fmt::format("{}{}{}", case_.source.stem().string(), part.empty() ? "" : "-", part);
}

void Recorder::open_series(std::optional<post::VtkSeries>& series, std::string_view part,
                           std::vector<std::string> entries) {
  series.emplace(folder_, series_name(part), series_model(case_, simulation_.device()), std::move(entries));
}

/// A time for every state, none twice: ParaView shows all states of a time at once. Where time passes it is
/// time, with steps before time starts counted backwards from 0, one unit each; without time it is the steps
/// that have ended and the load factor, or, as that goes back along a followed path, the number of the
/// record. A state at the time of the one before (behind a jump, in a ramp between two steps that take time)
/// comes a billionth of a step later.
double Recorder::series_time(const post::StepRecord& record) {
  const std::vector<Step>& steps = simulation_.steps();
  const auto timed = std::ranges::find_if(steps, [](const Step& step) { return step.duration.has_value(); });
  const bool follows = std::ranges::any_of(
      steps, [](const Step& step) { return step.on_instability == OnInstability::follow; });
  double time = steps_ended_ + record.load_factor, unit = 1;
  if (timed != steps.end()) {
    const auto before =
        std::count_if(steps.begin(), timed, [](const Step& step) { return !step.is_analysis(); });
    time = steps_ended_ < before ? time - static_cast<double>(before) : record.time;
    unit = *timed->duration;
  } else if (follows) {
    time = record.index;
  }
  constexpr double smallest_gap = 1e-9;
  if (series_time_ && time <= *series_time_)
    time = *series_time_ + smallest_gap * std::max(unit, std::abs(*series_time_));
  series_time_ = time;
  return time;
}

post::SeriesStep Recorder::series_step(double time, const std::string& name, double load_factor,
                                       std::span<const double> voltages) const {
  post::SeriesStep step{time, name, load_factor, {}};
  for (std::size_t e = 0; e < case_.electrodes.size() && e < voltages.size(); ++e)
    step.numbers.push_back({voltage_name(case_, e) + " [V]", voltages[e]});
  return step;
}

void Recorder::record_mode(const fem::CriticalPoint& critical, const post::Event& event) {
  const Device& device = simulation_.device();
  const fem::Samples samples = device.model.sample(critical.state);
  const std::vector<Eigen::Vector3d> mode =
      fem::displacements(device.model.dofs, critical.state, critical.mode.direction);
  Snapshot at = snapshot(device, event.message, critical.state, samples);
  Snapshot along = displaced(at, "displaced along its mode", mode, device.model.extent);
  journal_.critical = {std::move(at), std::move(along)};
  if (!case_.fields) return;
  if (!modes_) open_series(modes_, critical_name);
  modes_->write(series_step(++journal_.modes, event.message, critical.load_factor, critical.state.voltage),
                post::series_state(device.model, critical.state, samples),
                {mode, fem::spins(device.model.dofs, critical.state, critical.mode.direction)});
}

void Recorder::record_analysis(Analysis analysis, const fem::State& state) {
  std::string table = fmt::format("{}\n", fmt::join(analysis.columns, ","));
  for (const auto& row : analysis.rows) table += fmt::format("{}\n", fmt::join(row, ","));
  folder_.write(table_name(analysis.step), table);
  const Device& device = simulation_.device();
  const fem::Samples samples = device.model.sample(state);
  if (analysis.kind == StepKind::modes) {
    const Snapshot at = snapshot(device, "", state, samples);
    journal_.shapes.clear();
    for (std::size_t i = 0; i < std::min(analysis.shapes.size(), most_shapes); ++i)
      journal_.shapes.push_back(displaced(at, fmt::format("{}: {}", analysis.step, analysis.shapes[i].name),
                                          analysis.shapes[i].displacement, device.model.extent));
  }
  if (case_.fields) {
    post::VtkSeries series(folder_, series_name(analysis.step), series_model(case_, device));
    for (std::size_t i = 0; i < analysis.shapes.size(); ++i)
      series.write(series_step(static_cast<double>(i) + 1, analysis.shapes[i].name, 1, state.voltage),
                   post::series_state(device.model, state, samples),
                   {analysis.shapes[i].displacement, analysis.shapes[i].spin});
  }
  analysis.shapes.clear();
  journal_.analyses.push_back(std::move(analysis));
}

void Recorder::record(const Frame& frame) {
  const post::StepRecord& record = frame.record;
  history_->append(record.step, history_row(record, frame.values));
  if (series_) {
    if (waiting_ && waiting_->step.name != record.step) write_waiting();
    post::SeriesStep step =
        series_step(series_time(record), record.step, record.load_factor, record.voltages);
    for (std::size_t q = 0; q < case_.quantities.size(); ++q)
      step.numbers.push_back(
          {fmt::format("{} [{}]", case_.quantities[q].name, unit_of(case_.quantities[q], case_.quantities)),
           frame.values[q]});
    waiting_.reset();
    const fem::State& state = frame.measured.state;
    const fem::Samples& samples = frame.measured.samples;
    if (case_.all_states || frame.ends_step)
      series_->write(step, post::series_state(simulation_.device().model, state, samples));
    else
      waiting_ = {std::move(step), state, samples};
  }

  Snapshot now = snapshot(simulation_.device(), record.step, frame.measured.state, frame.measured.samples);
  if (case_.all_states && record.index % journal_.stills_every == 0) {
    journal_.stills.push_back(now);
    if (record.time > 0) journal_.stills.back().title += ", " + post::engineering(record.time, "s");
    if (journal_.stills.size() > most_stills) {
      std::vector<Snapshot> kept;
      for (std::size_t i = 0; i < journal_.stills.size(); i += 2)
        kept.push_back(std::move(journal_.stills[i]));
      journal_.stills = std::move(kept);
      journal_.stills_every *= 2;
    }
  }
  // The last accepted state is replaced until its step has ended.
  const bool replaces = record.index > 1 && journal_.records.back().step == record.step;
  const bool ended_before = replaces && journal_.records.back().load_factor >= 1; // and jumped from there
  if (replaces)
    journal_.snapshots.back() = std::move(now);
  else
    journal_.snapshots.push_back(std::move(now));
  journal_.records.push_back(record);
  journal_.values.push_back(frame.values);
  steps_ended_ += frame.ends_step && !ended_before;
  if (!frame.ends_path && std::chrono::steady_clock::now() > next_checkpoint_) save_checkpoint();
}

void Recorder::write_waiting() {
  if (series_ && waiting_)
    series_->write(waiting_->step,
                   post::series_state(simulation_.device().model, waiting_->state, waiting_->samples));
  waiting_.reset();
}

void Recorder::save_checkpoint() {
  const auto begin = std::chrono::steady_clock::now();
  const auto all = [](const auto& list) {
    json archived = json::array();
    for (const auto& one : list) archived.push_back(archive(one));
    return archived;
  };
  json values = json::array();
  for (const auto& row : journal_.values) values.push_back(post::pack(row));
  const auto entries = [](const auto& series) { return series ? json(series->entries()) : json::array(); };
  post::write_checkpoint(folder_ / checkpoint_name,
                         {{"case", fingerprint_},
                          {"files", folder_.names().size()},
                          {"progress", archive(simulation_.progress())},
                          {"factor", archive(simulation_.equilibrium().tangent().memory())},
                          {"results", post::pack(simulation_.results())},
                          {"rises", post::pack(simulation_.rises())},
                          {"steps_ended", steps_ended_},
                          {"series_time", series_time_ ? json(*series_time_) : json(nullptr)},
                          {"series", entries(series_)},
                          {"waiting", waiting_ ? archive(waiting_->step, waiting_->state) : json(nullptr)},
                          {"modes_series", entries(modes_)},
                          {"journal",
                           {{"records", all(journal_.records)},
                            {"values", values},
                            {"snapshots", all(journal_.snapshots)},
                            {"stills", all(journal_.stills)},
                            {"stills_every", journal_.stills_every},
                            {"modes", journal_.modes},
                            {"critical", all(journal_.critical)},
                            {"shapes", all(journal_.shapes)},
                            {"analyses", all(journal_.analyses)}}}});
  const std::chrono::nanoseconds taken = std::chrono::steady_clock::now() - begin;
  next_checkpoint_ = begin + std::max<std::chrono::nanoseconds>(checkpoint_interval, 30 * taken);
  kept_ = journal_.records.size();
}

void Recorder::restore_checkpoint() try {
  if (!std::filesystem::exists(folder_ / checkpoint_name))
    return folder_.begin(); // stopped before the first checkpoint: nothing is lost by starting over
  const json saved = post::read_checkpoint(folder_ / checkpoint_name);
  if (saved.at("case") != fingerprint_) throw post::CheckpointError("the case has changed since");
  const std::size_t files = saved.at("files");
  if (files > folder_.names().size()) throw post::CheckpointError("the manifest beside it is of another run");
  std::vector<std::string> kept(folder_.names().begin(),
                                folder_.names().begin() + static_cast<std::ptrdiff_t>(files));
  for (const std::string& name : kept)
    if (!std::filesystem::exists(folder_ / name))
      throw post::CheckpointError(fmt::format("{}, which belongs to it, is missing", name));
  simulation_.enter(saved.at("progress").at("step"));
  const Device& device = simulation_.device();
  const auto sizes = post::StateSizes::of(device.model);
  simulation_.resume(restore_progress(saved.at("progress"), sizes));
  if (const json& factor = saved.at("factor"); !factor.is_null())
    simulation_.equilibrium().tangent().recall(restore_factor(factor));
  simulation_.set_results(post::unpack(saved.at("results"), case_.quantities.size()),
                          post::unpack(saved.at("rises"), case_.quantities.size()));
  steps_ended_ = saved.at("steps_ended");
  if (const json& time = saved.at("series_time"); !time.is_null()) series_time_ = time.get<double>();
  const json& journal = saved.at("journal");
  journal_.modes = journal.at("modes");
  for (const json& analysis : journal.at("analyses")) journal_.analyses.push_back(restore_analysis(analysis));
  for (const json& record : journal.at("records")) journal_.records.push_back(restore_record(record));
  for (const json& row : journal.at("values"))
    journal_.values.push_back(post::unpack(row, case_.quantities.size()));
  if (journal_.values.size() != journal_.records.size()) throw post::CheckpointError("damaged");
  kept_ = journal_.records.size();
  for (const json& one : journal.at("snapshots"))
    journal_.snapshots.push_back(restore_snapshot(one, device.mesh));
  for (const json& one : journal.at("stills")) journal_.stills.push_back(restore_snapshot(one, device.mesh));
  journal_.stills_every = journal.at("stills_every");
  if (journal_.stills_every < 1) throw post::CheckpointError("damaged");
  for (const json& one : journal.at("critical"))
    journal_.critical.push_back(restore_snapshot(one, device.mesh));
  for (const json& one : journal.at("shapes")) journal_.shapes.push_back(restore_snapshot(one, device.mesh));
  folder_.begin(std::move(kept));
  if (!case_.fields) return;
  open_series(series_, "", saved.at("series"));
  if (const json& waiting = saved.at("waiting"); !waiting.is_null()) {
    waiting_ = {restore_series_step(waiting), post::restore_state(waiting.at("state"), sizes), {}};
    waiting_->samples = device.model.sample(waiting_->state);
  }
  if (journal_.modes > 0) open_series(modes_, critical_name, saved.at("modes_series"));
} catch (const json::exception&) {
  throw FileError((folder_ / checkpoint_name).string() + ": damaged; run again without --resume");
} catch (const post::CheckpointError& error) {
  throw FileError((folder_ / checkpoint_name).string() + ": " + error.what() +
                  "; run again without --resume");
}

} // namespace dielast::cases
