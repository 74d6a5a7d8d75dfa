// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/runs/recorder.hpp"

#include "fem/algebra/kept_factor.hpp"

namespace dielast::cases {

using nlohmann::json;

namespace {

json pack(const Eigen::VectorXd& values) {
  return post::pack({values.data(), static_cast<std::size_t>(values.size())});
}

/// A value per equation, or none.
Eigen::VectorXd unpack(const json& packed, const post::StateSizes& sizes) {
  const std::vector<double> values = post::unpack(packed);
  if (!values.empty() && values.size() != sizes.equations) throw post::CheckpointError("damaged");
  return Eigen::VectorXd::Map(values.data(), std::ssize(values));
}

} // namespace

json archive(const post::Event& event) {
  json archived{{"kind", event.kind},
                {"place", event.place},
                {"message", event.message},
                {"branches_off", event.branches_off}};
  if (event.before)
    archived["before"] = {event.before->load_factor, event.before->time, event.before->voltages};
  return archived;
}

post::Event restore_event(const json& archived) {
  post::Event event{archived.at("kind"), archived.at("place"), archived.at("message")};
  if (const auto before = archived.find("before"); before != archived.end())
    event.before = {before->at(0), before->at(1), before->at(2)};
  event.branches_off = archived.at("branches_off");
  return event;
}

/// As much of an increment as a record tells.
json archive(const fem::Increment& increment) {
  return {{"load_factor", increment.load_factor},
          {"iterations", increment.newton.iterations},
          {"residual", increment.newton.residual},
          {"unstable_modes", increment.newton.unstable_modes},
          {"jumped", increment.jumped}};
}

fem::Increment restore_increment(const json& archived) {
  return {.load_factor = archived.at("load_factor"),
          .newton = {.iterations = archived.at("iterations"),
                     .residual = archived.at("residual"),
                     .unstable_modes = archived.at("unstable_modes")},
          .jumped = archived.at("jumped")};
}

json archive(const SimulationProgress& progress) {
  json news = json::array();
  for (const post::Event& event : progress.news) news.push_back(archive(event));
  std::vector<double> peaks; // values and times
  for (const post::Peak& peak : progress.peaks) peaks.insert(peaks.end(), {peak.value, peak.time});
  const std::optional<fem::ContinuationProgress>& followed = progress.in_step.followed;
  return {{"step", progress.step},
          {"records", progress.records},
          {"ramp", post::archive(progress.in_step.ramp)},
          {"followed", followed ? post::archive(*followed) : json(nullptr)},
          {"folds", post::archive(progress.in_step.folds)},
          {"jumps", progress.in_step.jumps},
          {"energy", post::archive(progress.energy)},
          {"kept", progress.kept},
          {"active_events", progress.active_events},
          {"time_steps", {progress.time_steps.count, progress.time_steps.error}},
          {"let_go", pack(progress.let_go)},
          {"signals", progress.signals},
          {"news", std::move(news)},
          {"peaks", post::pack(peaks)},
          {"taken", {progress.taken.states, progress.taken.iterations}},
          {"unrecorded", progress.unrecorded ? archive(*progress.unrecorded) : json(nullptr)},
          {"unseen",
           {{"kinetic", progress.unseen.kinetic},
            {"size", progress.unseen.size},
            {"start", pack(progress.unseen.start)},
            {"farthest", pack(progress.unseen.farthest)}}}};
}

SimulationProgress restore_progress(const json& archived, const post::StateSizes& sizes) {
  SimulationProgress progress;
  progress.step = archived.at("step");
  progress.records = archived.at("records");
  progress.in_step = {post::restore_ramp(archived.at("ramp"), sizes),
                      {},
                      post::restore_points(archived.at("folds"), sizes),
                      archived.at("jumps")};
  if (const json& followed = archived.at("followed"); !followed.is_null())
    progress.in_step.followed = post::restore_continuation(followed, sizes);
  progress.energy = post::restore_energy(archived.at("energy"), sizes);
  progress.kept = archived.at("kept");
  progress.active_events = archived.at("active_events");
  progress.time_steps = {archived.at("time_steps").at(0), archived.at("time_steps").at(1)};
  progress.let_go = unpack(archived.at("let_go"), sizes);
  progress.signals = archived.at("signals");
  for (const json& event : archived.at("news")) progress.news.push_back(restore_event(event));
  const std::vector<double> peaks = post::unpack(archived.at("peaks"));
  for (std::size_t i = 0; i + 1 < peaks.size(); i += 2) progress.peaks.push_back({peaks[i], peaks[i + 1]});
  progress.taken = {archived.at("taken").at(0), archived.at("taken").at(1)};
  if (const json& unrecorded = archived.at("unrecorded"); !unrecorded.is_null())
    progress.unrecorded = restore_increment(unrecorded);
  const json& unseen = archived.at("unseen");
  progress.unseen = {unseen.at("kinetic"), unseen.at("size"), unpack(unseen.at("start"), sizes),
                     unpack(unseen.at("farthest"), sizes)};
  return progress;
}

json archive(const fem::FactorMemory* memory) {
  if (!memory) return nullptr;
  return {{"values", post::pack(memory->values)},
          {"proves", memory->proves},
          {"fails", memory->fails},
          {"fresh", memory->fresh},
          {"debt", memory->debt}};
}

fem::FactorMemory restore_factor(const json& archived) {
  return {post::unpack(archived.at("values")), archived.at("proves"), archived.at("fails"),
          archived.at("fresh"), archived.at("debt")};
}

SimulationProgress Simulation::progress() const {
  SimulationProgress progress{
      step_,       records_,       in_step_, energy_.record(), measurement_.kept,  watch_.active,
      time_steps_, loads_->let_go, {},       unseen_,          measurement_.peaks, news_,
      taken_,      unrecorded_};
  for (const auto& [load, signal] : signals_) progress.signals.push_back(signal->memory());
  return progress;
}

void Simulation::resume(const SimulationProgress& progress) {
  step_ = progress.step + (progress.in_step.ramp.load_factor >= 1 ? 1 : 0); // that step is done
  records_ = progress.records;
  in_step_ = progress.in_step;
  energy_ = fem::EnergyBalance(progress.energy);
  come_to(state());
  measurement_.kept = progress.kept;
  watch_.active = progress.active_events;
  time_steps_ = progress.time_steps;
  unseen_ = progress.unseen;
  if (progress.peaks.size() != measurement_.peaks.size()) throw post::CheckpointError("damaged");
  measurement_.peaks = progress.peaks;
  news_ = progress.news;
  taken_ = progress.taken;
  unrecorded_ = progress.unrecorded;
  refusal_.reset();
  loads_->let_go = progress.let_go;
  if (progress.signals.size() != signals_.size()) throw post::CheckpointError("damaged");
  auto kept = progress.signals.begin();
  for (const auto& [load, signal] : signals_) {
    if (kept->size() != signal->memory().size()) throw post::CheckpointError("damaged");
    signal->recall(*kept++);
  }
}

} // namespace dielast::cases
