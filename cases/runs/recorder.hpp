// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/runs/simulation.hpp"
#include "post/files/checkpoint.hpp"
#include "post/files/history.hpp"
#include "post/files/vtk_series.hpp"

#include <chrono>
#include <filesystem>
#include <optional>

namespace dielast::cases {

/// A state kept for the report's pictures.
struct Snapshot {
  std::string title;
  double voltage = 0;                        ///< largest, V
  std::vector<Eigen::Vector3d> displacement; ///< per node, m
  std::vector<double> shape;                 ///< ShapeField, per triangle
  std::vector<double> field;                 ///< true electric field, V/m, per triangle
};

/// The field that tells how a device has deformed.
struct ShapeField {
  std::string name, meaning, unit;
};
ShapeField shape_field(const Device& device);

/// What series for ParaView show of a device, which must outlive it.
post::SeriesModel series_model(const Case& one, const Device& device);

/// File of a run's checkpoint in its folder of results; removed when they are complete.
inline constexpr const char* checkpoint_name = "checkpoint.cbor";

/// What a run has gathered so far.
struct Journal {
  std::vector<post::StepRecord> records;
  std::vector<std::vector<double>> values; ///< of the quantities, per record
  std::vector<Snapshot> snapshots;         ///< drawn, the end of each step, and the last accepted state
  std::vector<Snapshot> stills; ///< of the states 0, stills_every, 2 stills_every, ...: a bounded number
  int stills_every = 1;
  int modes = 0;                  ///< of critical points, written so far
  std::vector<Snapshot> critical; ///< the last critical point, and it displaced along its mode; or none
  std::vector<Snapshot>
      shapes; ///< of the vibrations that the last step of kind "modes" has found, the lowest
  std::vector<Analysis> analyses;
};

/// An event in a checkpoint.
nlohmann::json archive(const post::Event& event);
post::Event restore_event(const nlohmann::json& archived);

/// A simulation's progress in a checkpoint, bit for bit.
nlohmann::json archive(const SimulationProgress& progress);
/// Throws CheckpointError and what JSON throws where it is not that of a model of these sizes.
SimulationProgress restore_progress(const nlohmann::json& archived, const post::StateSizes& sizes);

/// The factor that the next steps of Newton's method are solved with, or null.
nlohmann::json archive(const fem::FactorMemory* memory);
fem::FactorMemory restore_factor(const nlohmann::json& archived);

/// Writes history.csv, the ParaView series and the checkpoint of a run as it goes, and keeps its journal.
/// Everything throws post::WriteError when a file cannot be written.
class Recorder {
 public:
  /// With `resume`, restores the simulation and the journal from the directory's checkpoint, and makes the
  /// history and the series' lists anew of what it holds; starts over when there is none. Throws FileError
  /// when the checkpoint is damaged or of another case.
  Recorder(const Case& one, Simulation& simulation, post::ResultsFolder& folder, bool resume);

  void record(const Frame& frame);
  /// Adds the mode of a critical point to the series `<case>-critical`.
  void record_mode(const fem::CriticalPoint& critical, const post::Event& event);
  /// Writes `<step>.csv` and the shapes as the series `<case>-<step>`, about `state`.
  void record_analysis(Analysis analysis, const fem::State& state);
  /// Writes the checkpoint now; the run can be resumed from it.
  void save_checkpoint();
  /// Recorded states that the last checkpoint holds.
  std::size_t kept() const { return kept_; }
  /// Writes the last state into the series where it has not been: a run that ends within a step keeps it.
  void write_waiting();

  const Journal& journal() const { return journal_; }

 private:
  /// A state of the series that is written where no other of its step follows.
  struct WaitingState {
    post::SeriesStep step;
    fem::State state;
    fem::Samples samples;
  };
  double series_time(const post::StepRecord& record);
  post::SeriesStep series_step(double time, const std::string& name, double load_factor,
                               std::span<const double> voltages) const;
  void restore_checkpoint();
  /// Name of a series: `<case>`, or `<case>-<part>`.
  std::string series_name(std::string_view part) const;
  /// Opens a series behind the `entries` of its list that are kept.
  void open_series(std::optional<post::VtkSeries>& series, std::string_view part,
                   std::vector<std::string> entries = {});

  const Case& case_;
  Simulation& simulation_;
  post::ResultsFolder& folder_;
  std::string fingerprint_; ///< the resolved case
  Journal journal_;
  int steps_ended_ = 0;
  std::optional<double> series_time_; ///< of the last state
  std::optional<post::History> history_;
  std::optional<WaitingState> waiting_;
  std::optional<post::VtkSeries> series_, modes_;
  std::chrono::steady_clock::time_point next_checkpoint_;
  std::size_t kept_ = 0;
};

} // namespace dielast::cases
