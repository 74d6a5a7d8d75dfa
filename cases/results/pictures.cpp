// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/results/results.hpp"
#include "post/pictures/picture.hpp"
#include "post/pictures/plot.hpp"
#include "post/pictures/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace dielast::cases {

namespace {

/// What pictures of one device share.
class Pictures {
 public:
  Pictures(const Device& device, const Snapshot& last)
      : device_(device), meridian_(meshing::is_meridian(device.mesh.film()->type)),
        solid_of_revolution_(device.solid && device.mesh.bounds().sizes().y() == 0) {
    // Thickness and field jump where an electrode or a part ends: they are not smoothed across it.
    std::map<std::array<int, 3>, int> numbers;
    std::vector<int> electrodes(last.field.size(), -1);
    for (const fem::MembraneSample& sample : device.model.sample(device.model.initial_state()).film) {
      int& electrode = electrodes[static_cast<std::size_t>(sample.cell)];
      electrode = std::max(electrode, sample.electrode);
    }
    for (std::size_t cell = 0; cell < electrodes.size(); ++cell) {
      const std::array key{device.film_parts[cell], electrodes[cell], last.field[cell] != 0 ? 1 : 0};
      regions_.push_back(numbers.try_emplace(key, static_cast<int>(numbers.size())).first->second);
    }
    for (const FinPoints& fin : device.fins) fins_.push_back(fin.corners);
  }

  post::Panel panel(const Snapshot& snapshot, const std::vector<double>& values) const {
    post::Panel panel{.title = snapshot.title, .positions = device_.mesh.nodes, .values = values};
    if (snapshot.voltage != 0) panel.title += ", " + post::engineering(snapshot.voltage, "V");
    if (values.size() == regions_.size()) panel.regions = regions_;
    for (std::size_t n = 0; n < panel.positions.size(); ++n) {
      Eigen::Vector3d& place = panel.positions[n];
      place += snapshot.displacement[n];
      if (solid_of_revolution_) place = {place.x(), place.z(), 0}; // seen along the hoops
    }
    return panel;
  }

  /// Side by side, as wide as the page, in a file of that name. `values`: a member of the snapshots, whose
  /// colours mean `quantity` in `unit`. Films of revolution are drawn by their profiles, without colours.
  post::Image image(const std::vector<const Snapshot*>& states, std::vector<double> Snapshot::*values,
                    const std::string& quantity, const std::string& unit, const std::string& caption,
                    const std::string& name) const {
    post::Picture picture{
        .quantity = quantity, .unit = unit, .wall_widths = device_.bars.widths, .fins = fins_};
    for (const Snapshot* state : states) picture.panels.push_back(panel(*state, state->*values));
    return image(std::move(picture), caption, true, name);
  }
  /// One at a time.
  post::Slides slides(const std::vector<Snapshot>& states, const ShapeField& shown) const {
    post::Picture picture{.quantity = shown.meaning,
                          .unit = shown.unit,
                          .wall_widths = device_.bars.widths,
                          .fins = fins_,
                          .width = 900};
    for (const Snapshot& state : states) picture.panels.push_back(panel(state, state.shape));
    return post::draw_slides(device_.mesh, std::move(picture));
  }
  /// A small picture without colours.
  post::Image shape(const Snapshot& state, const std::string& caption) const {
    return image(
        {.wall_widths = device_.bars.widths, .fins = fins_, .panels = {panel(state, {})}, .width = 800},
        caption, false, "mode " + state.title);
  }
  /// The device as drawn with these of its places.
  post::Image places(std::vector<post::Mark> marks) const {
    return image({.wall_widths = device_.bars.widths,
                  .fins = fins_,
                  .panels = {panel({.displacement = std::vector<Eigen::Vector3d>(device_.mesh.nodes.size(),
                                                                                 Eigen::Vector3d::Zero())},
                                   {})},
                  .marks = std::move(marks),
                  .width = 900},
                 "As drawn.", false, "places");
  }
  bool are_profiles() const { return meridian_; }

 private:
  post::Image image(post::Picture picture, const std::string& caption, bool wide,
                    const std::string& name) const {
    post::Image image;
    if (meridian_) {
      auto drawn = post::draw({post::profile_plot(
          device_.mesh, picture.panels.size() == 1 ? picture.panels.front().title : "Meridian",
          picture.panels)});
      if (!drawn.empty()) image = std::move(drawn.front());
      image.name = name;
    } else {
      image = post::draw(device_.mesh, std::move(picture), name);
      image.wide = wide;
    }
    image.caption = caption;
    return image;
  }

  const Device& device_;
  bool meridian_, solid_of_revolution_;
  std::vector<int> regions_;
  std::vector<std::array<int, 4>> fins_;
};

/// Places of the mesh that the case's quantities, supports and loads name: not the whole of it.
std::vector<post::Mark> named_places(const Case& one, const meshing::Mesh& mesh) {
  std::set<std::string> names;
  for (const Quantity& quantity : one.quantities)
    names.insert({quantity.between[0], quantity.between[1], quantity.of, quantity.place});
  for (const Profile& profile : one.profiles) names.insert(profile.of);
  for (const Support& support : one.supports) names.insert(support.place);
  for (const Load& load : one.loads) names.insert(load.place);
  std::vector<post::Mark> marks;
  for (const std::string& name : names)
    if (const auto place = mesh.node_sets.find(name);
        place != mesh.node_sets.end() && place->second.size() < mesh.nodes.size() / 2)
      marks.push_back({name, place->second});
  return marks;
}

/// Largest less smallest.
double spread(const std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto ends = std::ranges::minmax_element(values);
  return *ends.max - *ends.min;
}

/// Film without a field is grey in pictures of the field.
Snapshot without_passive(Snapshot snapshot) {
  for (double& field : snapshot.field)
    if (field == 0) field = NAN;
  return snapshot;
}

} // namespace

std::vector<post::Section> picture_sections(const Case& one, const Device& device, const Journal& journal) {
  const auto& all = journal.snapshots;
  const Snapshot& last = all.back();
  const Pictures pictures(device, last);
  const ShapeField shown = shape_field(device);
  std::vector<const Snapshot*> ends{&last};
  if (all.size() > 1) ends.insert(ends.begin(), &all[all.size() - 2]);
  std::vector<post::Section> sections{
      {"Shape",
       {pictures.image(ends, &Snapshot::shape, shown.meaning, shown.unit,
                       "Before and after the last step, to one scale.", "shape")}}};
  std::vector<double> both = ends.front()->shape;
  both.insert(both.end(), last.shape.begin(), last.shape.end());
  if (!pictures.are_profiles() && spread(last.shape) < 0.5 * spread(both))
    sections.back().blocks.push_back(pictures.image({&last}, &Snapshot::shape, shown.meaning, shown.unit,
                                                    "After the last step, in colours of its own.",
                                                    "shape at the end"));
  if (journal.stills.size() > 2 && !pictures.are_profiles()) {
    std::vector<Snapshot> along = journal.stills;
    // The last state may be none of those kept.
    if (along.back().title != last.title || along.back().displacement != last.displacement)
      along.push_back(last);
    post::Slides slides = pictures.slides(along, shown);
    slides.caption = "The way there, state by state, to one scale.";
    sections.back().blocks.push_back(std::move(slides));
  }
  if (!journal.critical.empty())
    sections.push_back({"Critical mode",
                        {pictures.image({&journal.critical[0], &journal.critical[1]}, &Snapshot::shape,
                                        shown.meaning, shown.unit,
                                        "The last critical point, and displaced along its mode, much "
                                        "exaggerated.",
                                        "critical mode")}});
  if (!journal.shapes.empty()) {
    post::Section modes{"Mode shapes", {}};
    for (const Snapshot& shape : journal.shapes)
      modes.blocks.push_back(pictures.shape(shape, "Much exaggerated."));
    sections.push_back(std::move(modes));
  }
  double most = 0; // V; a sine ends at its rounding
  for (const auto* states : {&all, &journal.stills})
    for (const Snapshot& state : *states) most = std::max(most, std::abs(state.voltage));
  if (std::abs(last.voltage) > 1e-6 * most && !pictures.are_profiles()) {
    const Snapshot charged = without_passive(last);
    sections.push_back(
        {"Electric field",
         {pictures.image({&charged}, &Snapshot::field, "True electric field", "V/m",
                         "In the last state; film without a field is grey.", "electric field")}});
  }
  if (auto marks = named_places(one, device.mesh); !pictures.are_profiles() && !marks.empty())
    sections.push_back({"Places", {pictures.places(std::move(marks))}});
  return sections;
}

} // namespace dielast::cases
