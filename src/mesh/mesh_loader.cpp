/// The order of repairs: weld, drop what is degenerate, close holes, orient, unite shells. Each step that changed
/// something is a flag of the report.
#include "bin_scenes/mesh/mesh_loader.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"
#include "mesh_file.hpp"
#include "mesh_repair.hpp"
#include "mesh_words.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

void check_options(const LoadOptions& options, const std::string& where) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  if (!positive(options.scale)) {
    throw input_error("scale is " + number(options.scale), where, "give a scale above 0");
  }
  if (!(options.weld >= 0.0 && options.weld <= 0.01)) {
    throw input_error("weld distance is " + number(options.weld) + " of the diagonal", where, "give 0 to 0.01");
  }
  if (!(options.max_hole >= 0.0)) throw input_error("max_hole is " + number(options.max_hole), where, "give 0 to 1");
  if (options.thickness && !positive(*options.thickness)) {
    throw input_error("thickness is " + number(*options.thickness) + " m", where, "give a thickness above 0");
  }
  const Tessellation& fine = options.tessellation;
  if (fine.chord && !positive(*fine.chord))
    throw input_error("tessellation.chord is " + number(*fine.chord) + " m", where, "give a distance above 0");
  if (!(fine.angle >= 0.01 && fine.angle <= 1.0))
    throw input_error("tessellation.angle is " + number(fine.angle) + " rad", where, "give 0.01 to 1");
}

/// Refuses what no repair can make sense of. Returns the bounding diagonal.
double check_vertices(const Mesh& mesh, const std::string& where) {
  if (mesh.empty()) throw input_error("holds no triangles", where, "export the part as a closed surface");
  Aabb box;
  std::size_t bad = 0;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      if (v >= mesh.vertices.size()) {
        throw input_error(
            "a triangle names vertex " + std::to_string(v) + " of " + std::to_string(mesh.vertices.size()), where,
            "the mesh is damaged: export it again");
      }
      if (!mesh.vertices[v].allFinite()) {
        ++bad;
      } else {
        box.extend(mesh.vertices[v]);
      }
    }
  }
  if (bad > 0) {
    throw input_error(count(bad, "triangle corner") + " not finite (NaN or infinite coordinates)", where,
                      "the exporter wrote broken numbers: export it again");
  }
  const double diagonal = box.diagonal();
  if (diagonal == 0.0) throw input_error("all vertices lie in one point", where, "export the part again");
  if (diagonal > 1e5 || diagonal < 1e-7) {
    throw input_error("is " + number(diagonal) + " m across, which no part is", where, "check its unit and scale");
  }
  // Float32 files lose what lies below 1e-7 of the distance to their origin.
  if (box.center().norm() > 1e6 * diagonal) {
    throw input_error("lies " + number(box.center().norm()) + " m from the origin of its file, " +
                          number(box.center().norm() / diagonal) + " times its size: its shape is lost in rounding",
                      where, "move it to the origin in the modeller and export it again");
  }
  return diagonal;
}

/// The repairs in their order. Each leaves a flag with figures and a remedy.
class Repair {
 public:
  Repair(LoadedMesh& loaded, const LoadOptions& options, const std::string& where, double diagonal)
      : mesh_(loaded.mesh), report_(loaded.report), options_(options), where_(where), diagonal_(diagonal) {}

  void run() {
    for (void (Repair::*step)() :
         {&Repair::weld, &Repair::remove_duplicates, &Repair::remove_slivers, &Repair::agree_winding,
          &Repair::close_holes, &Repair::thicken, &Repair::turn_outward, &Repair::unite, &Repair::judge}) {
      stop_if_cancelled();
      (this->*step)();
    }
  }

 private:
  Error encloses_nothing() const {
    return input_error(
        "the surface encloses nothing, its volume is 0: it is flat, or every face is there twice, once facing in each "
        "direction",
        where_, "export the part as a solid, single-sided (without back faces)");
  }
  double tolerance() const { return options_.weld * diagonal_; }
  void flag(const char* code, const std::string& text, const std::string& remedy) {
    report_.flags.push_back({code, text, remedy});
  }

  void weld() {
    const repair::Welded welded = repair::weld(mesh_, tolerance());
    report_.welded_vertices = welded.vertices;
    report_.degenerate_removed = welded.triangles;
    if (mesh_.empty()) {
      throw input_error("every triangle is smaller than the weld distance of " + number(tolerance()) + " m", where_,
                        "lower the weld distance, or export the part again");
    }
  }

  void remove_duplicates() {
    const std::size_t before = mesh_.triangles.size();
    const repair::Duplicates found = repair::remove_duplicates(mesh_, options_.thickness.has_value());
    report_.duplicate_removed = before - mesh_.triangles.size();
    if (mesh_.empty()) {
      throw encloses_nothing();
    }
    if (found.same > 0) {
      flag("duplicates_removed", count(found.same, "triangle") + " removed that repeat another one",
           "nothing to do unless two shells were meant");
    }
    if (found.opposite_pairs > 0) {
      flag("double_faces_removed",
           count(found.opposite_pairs, "pair") + " of equal triangles that face opposite directions: " +
               (options_.thickness ? "one of each pair kept" : "removed, since they enclose nothing"),
           "export the part single-sided");
    }
  }

  /// Slivers go where their neighbours can be joined without them; else they stay, they do little harm.
  void remove_slivers() {
    const Mesh whole = mesh_;
    const std::size_t open_before = repair::open_edges(mesh_);
    std::size_t slivers = 0, junctions = 0;
    for (int round = 0; round < 10; ++round) {
      const std::size_t removed = repair::remove_slivers(mesh_, tolerance());
      const std::size_t split = repair::split_t_junctions(mesh_, junction_tolerance());
      slivers += removed;
      junctions += split;
      if (removed + split == 0) break;
    }
    if (mesh_.empty()) {
      throw input_error("all triangles are thinner than " + number(tolerance()) + " m: there is no surface", where_,
                        "export the part again");
    }
    if (slivers > 0 && repair::open_edges(mesh_) > open_before) {
      mesh_ = whole;
      slivers = 0;
      junctions = repair::split_t_junctions(mesh_, junction_tolerance());
    }
    report_.degenerate_removed += slivers;
    report_.t_junctions_split = junctions;
    if (report_.degenerate_removed > 0) {
      flag("degenerate_removed", count(report_.degenerate_removed, "triangle") + " without area removed",
           "nothing to do: no hole was opened");
    }
    if (junctions > 0) {
      flag("t_junctions_split",
           std::to_string(junctions) + (junctions == 1 ? " vertex" : " vertices") +
               " put into edges they lie on (T-junctions without a gap)",
           "nothing to do: the shape is unchanged within " + number(junction_tolerance()) + " m");
    }
  }
  /// A vertex in the centre of an edge is off it by its own rounding in the file: six decimals of a part of 5 cm are
  /// 1e-5 of it, though equal vertices agree to the last digit. Only open edges are looked at, so this is safe.
  double junction_tolerance() const { return 20.0 * tolerance(); }

  void agree_winding() {
    const repair::Agreement agreement = repair::agree_winding(mesh_);
    report_.turned = agreement.turned;
    if (agreement.conflicts > 0) {
      throw input_error("the surface has only one side (like a Moebius strip): " + count(agreement.conflicts, "edge") +
                            " cannot be given an outside",
                        where_, "a part must be a solid: repair it in the modeller");
    }
    if (agreement.turned > 0) {
      flag("winding_unified", count(agreement.turned, "triangle") + " turned to the same side as their neighbours",
           "recompute normals in the modeller");
    }
  }

  void close_holes() {
    // 1 stands for every hole: the perimeter of a large one may well exceed the diagonal.
    const double limit =
        options_.max_hole >= 1.0 ? std::numeric_limits<double>::infinity() : options_.max_hole * diagonal_;
    // A surface that is to become a shell keeps its openings.
    if (options_.thickness) return;
    const repair::Closed closed = repair::close_holes(mesh_, limit);
    report_.holes_closed = closed.small + closed.hidden;
    if (closed.small > 0) {
      const std::string size = options_.max_hole >= 1.0 ? ""
                                                        : ", at most " + number(100.0 * options_.max_hole) +
                                                              " % of the diagonal around (" + number(limit) + " m)";
      flag("holes_closed", count(closed.small, "hole") + " closed" + size,
           "check that no opening of the part was meant");
    }
    if (closed.hidden > 0) {
      flag("hidden_holes_closed", count(closed.hidden, "hole") + " closed inside another closed shell of the part",
           "nothing to do: the outside is unchanged");
    }
  }

  void thicken() {
    if (!options_.thickness) return;
    if (*options_.thickness > diagonal_) {
      throw input_error("the thickness of " + number(*options_.thickness) + " m is more than the part is large, " +
                            number(diagonal_) + " m",
                        where_, "give the thickness of its walls in m, or check the part's unit and scale");
    }
    if (repair::open_edges(mesh_) == 0) {
      flag("thickness_unused",
           "the surface is closed: the thickness of " + number(*options_.thickness) + " m is not used",
           "remove the thickness from the request");
      return;
    }
    repair::thicken(mesh_, *options_.thickness);
    flag("shell_thickened", "the open surface was made a shell " + number(*options_.thickness) + " m thick",
         "export a solid if the part is one");
  }

  void turn_outward() {
    if (repair::open_edges(mesh_) > 0) return;
    const std::size_t turned = repair::turn_outward(mesh_);
    report_.inverted = turned > 0;
    if (turned > 0) {
      flag("winding_inverted", count(turned, "triangle") + " turned: their shell was inside out",
           "flip its normals in the modeller");
    }
  }

  /// Solids that overlap would count twice in the mass, and their buried walls as surface.
  void unite() {
    if (repair::open_edges(mesh_) > 0) return;
    const std::size_t overlaps = repair::overlapping_pairs(mesh_);
    if (overlaps == 0) return;
    const std::string what = count(overlaps, "pair") + " of closed shells overlap: ";
    if (repair::unite(mesh_, tolerance())) {
      flag("shells_united", what + "they were united, so that the space they share counts once",
           "nothing to do: the outside is unchanged");
    } else {
      flag("shells_overlap", what + "the space they share counts twice in volume and mass",
           "unite them in the modeller, or give the part's mass instead of its density");
    }
  }

  void judge() {
    report_.open_edges = repair::open_edges(mesh_);
    report_.closed = report_.open_edges == 0;
    report_.shells = repair::shells(mesh_).count;
    if (!report_.closed) {
      double largest = 0.0;
      const auto loops = repair::boundary_loops(mesh_);
      for (const auto& loop : loops) largest = std::max(largest, repair::perimeter(mesh_, loop));
      const std::string text = "the surface is not closed: " + count(report_.open_edges, "open edge") + " around " +
                               count(loops.size(), "hole") + ", the largest " + number(largest) + " m (" +
                               number(largest / diagonal_) + " of the diagonal) around";
      const std::string remedy = "close it in the modeller, or give a thickness to make a shell of it";
      if (options_.require_closed) throw input_error(text, where_, remedy);
      flag("surface_open", text, remedy);
      return;
    }
    const double volume = repair::signed_volume(mesh_);
    // Rounding leaves about 1e-16 of area times diagonal; a real part of foil, 1e-5 of its size thick, 1e-6 of it.
    if (std::abs(volume) <= 1e-9 * repair::area(mesh_) * diagonal_) {
      throw encloses_nothing();
    }
    if (volume < 0.0) {
      throw input_error("the enclosed volume is negative (" + number(volume) + " m3): cavities exceed the solid",
                        where_, "recompute normals in the modeller");
    }
  }

  Mesh& mesh_;
  LoadReport& report_;
  const LoadOptions& options_;
  const std::string& where_;
  double diagonal_;
};

}  // namespace

LoadOptions load_options(const PartLine& line) {
  LoadOptions options;
  options.unit = line.unit;
  options.scale = line.scale;
  options.thickness = line.thickness;
  options.tessellation = line.tessellation;
  options.solid = line.solid;
  return options;
}

LoadedMesh repair_mesh(Mesh mesh, const LoadOptions& options, const std::string& where) {
  check_options(options, where);
  LoadedMesh loaded;
  loaded.report.file_vertices = mesh.vertices.size();
  loaded.report.file_triangles = mesh.triangles.size();
  loaded.report.meshes = 1;
  const double diagonal = check_vertices(mesh, where);
  loaded.mesh = std::move(mesh);
  Repair(loaded, options, where, diagonal).run();
  BIN_SCENES_ASSERT(indices_in_range(loaded.mesh) && loaded.report.closed == (loaded.report.open_edges == 0));
  BIN_SCENES_ASSERT(!options.require_closed || loaded.report.closed);
  return loaded;
}

LoadedMesh load_mesh(const std::string& path, const LoadOptions& options) {
  check_options(options, path);
  return load_mesh(read_model_file(path), options);
}

LoadedMesh load_mesh(const ModelFile& model, const LoadOptions& options) {
  const std::string& path = model.path;
  check_options(options, path);
  MeshFile file = parse_mesh_file(model, options);
  const double own_unit = file.metres_per_unit.value_or(1.0);
  const double metres = options.unit ? metres_per(*options.unit) : own_unit;
  BIN_SCENES_ASSERT(metres > 0.0 && options.scale > 0.0);
  for (Vec3& v : file.mesh.vertices) v *= metres * options.scale;

  LoadedMesh loaded = repair_mesh(std::move(file.mesh), options, path);
  LoadReport& report = loaded.report;
  report.format = file.format;
  report.meshes = file.meshes;
  report.content_sha256 = model.sha256;
  report.metres_per_unit = metres;
  report.file_metres_per_unit = own_unit;
  report.tessellation_error = metres * options.scale * file.tessellation_error;
  for (const Unit unit : {Unit::metre, Unit::centimetre, Unit::millimetre, Unit::inch}) {
    if (std::abs(metres_per(unit) - metres) <= 1e-6 * metres) report.unit = unit;
  }
  if (options.unit && file.metres_per_unit && std::abs(metres - own_unit) > 1e-6 * metres) {
    file.flags.push_back({"unit_overridden",
                          "the file states a unit of " + number(own_unit) + " m; the given " +
                              std::string(name_of(*options.unit)) + " is used",
                          "leave the unit out to use the file's own"});
  }
  report.flags.insert(report.flags.begin(), file.flags.begin(), file.flags.end());
  return loaded;
}

}  // namespace bin_scenes
