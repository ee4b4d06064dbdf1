/// bin_scenes: the command line.
#include "bin_scenes/config/plan.hpp"
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/freed_memory.hpp"
#include "tool/commands.hpp"

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>

namespace {

using namespace bin_scenes;

int complain(const std::string& message, int code) {
  std::cerr << "bin_scenes: " << message << std::endl;
  return code;
}

void add_generate(CLI::App& app, GenerateOptions& o) {
  app.add_option("REQUEST", o.request, "request file (docs/use/request.md)")->required();
  app.add_option("--out", o.out, "directory for the scenes: DIR/scene_000000/scene.json and so on")->required();
  app.add_option("--seed", o.seed, "seed of all scenes; scene i comes from (seed, i) alone");
  app.add_option("--scenes", o.scenes, "number of scenes");
  app.add_option("--first", o.first, "index of the first scene, to split a job");
  app.add_option("--solver", o.solver, "auto, sphere or bullet");
  app.add_option("--formats", o.formats, "of json, pcd, ply, png, bop, bag; scene.json is always written")
      ->delimiter(',');
  app.add_option("--set", o.set, "key=value: overrides any key of the request by its path");
  app.add_option("--seconds", o.seconds, "simulate exactly this long instead of until rest");
  app.add_option("--trace", o.trace,
                 "file with pose and velocity of each part over simulated time: .csv, or .bag (poses alone, as TF)");
  app.add_option("--trace-rate", o.trace_rate, "rows a second and part")->capture_default_str();
  app.add_flag("--overwrite", o.overwrite, "make scenes anew that are there already");
  app.add_flag(
      "--verify", o.verify,
      "read scenes that are there already and make those anew whose files have changed (else only sizes count)");
  app.add_flag("--verbose", o.verbose, "stage times and counters of each scene");
}

void add_dataset(CLI::App& app, DatasetOptions& o) {
  app.add_option("PLAN", o.plan, "plan of the data set (docs/use/datasets.md)");
  app.add_option("--out", o.out, "directory of the data set");
  app.add_option("--workers", o.workers, "processes; left out: as many as cores")->check(CLI::Range(1, 1024));
  app.add_option("--shard", o.shard, "i/n: makes share i, from 0, of n; `dataset merge` joins them");
  app.add_flag("--resume", "go on with what is there, as is done without it");
  app.add_flag("--json-progress", o.json_progress, "progress as lines of JSON on standard output");
}

void add_audit(CLI::App& app, AuditOptions& o) {
  app.add_option("DIR", o.directory, "a data set, one of its splits, or one scene")->required();
  app.add_option(
      "--bin", o.bin,
      "inner size x,y,z (m) of a bin around the world's origin, floor at z = 0; or fitted: as wide as each heap");
  app.add_option("--floor", o.floor, "height (m) of a table; left out, without --bin: fitted to the lowest parts");
  app.add_option("--up", o.up, "x,y,z: up in the set's world, or in the camera's frame where it tells no world");
  app.add_option("--sensor", o.sensor, "of a set with several; left out: the first one");
  app.add_option("--models", o.models, "folder of the models; left out: models beside or above the scenes");
  app.add_option("--most", o.most, "heaps to audit; left out: all");
  app.add_option("--out", o.out, "HTML file with the table and a histogram of each measure");
  app.add_flag("--json", o.json, "as JSON");
}

void add_inspect(CLI::App& app, InspectOptions& o) {
  app.add_option("MODEL", o.model, "mesh or CAD file")->required();
  app.add_option("--unit", o.unit, "unit of the file: m, cm, mm or inch");
  app.add_option("--solid", o.solid, "of a STEP or IGES file with several");
  app.add_option("--chord", o.chord, "m: largest distance of triangles from the surface of a STEP or IGES file");
  app.add_option("--angle", o.angle, "rad: between neighbouring triangles of its curved surfaces");
  app.add_option("--hulls", o.hulls, "OBJ file to write the convex hulls to, an object each (m)");
  app.add_flag("--json", o.json, "as JSON");
}

void add_symmetries(CLI::App& app, SymmetriesOptions& o) {
  app.add_option("PART", o.model, "mesh or CAD file")->required();
  app.add_option("--unit", o.unit, "unit of the file: m, cm, mm or inch");
  app.add_option("--solid", o.solid, "of a STEP or IGES file with several");
  app.add_option("--tolerance", o.tolerance_mm,
                 "mm that surfaces may lie apart; left out: a hundredth of the part's size");
  app.add_option("--picture", o.picture, "PNG file of the part with its axes");
  app.add_flag("--json", o.json, "as JSON");
}

void add_sensor(CLI::App& app, SensorOptions& o) {
  app.add_option("SENSOR", o.sensor, "name of a preset, or a file of sensor keys")->required();
  app.add_option("--plot", o.plot, "SVG file: predicted noise over distance, incidence and albedo");
  app.add_flag("--json", o.json, "as JSON");
}

void add_submit(CLI::App& app, SubmitOptions& o) {
  app.add_flag("--slurm", o.slurm, "by an array job of Slurm")->required();
  app.add_option("PLAN", o.plan, "plan of the data set")->required();
  app.add_option("--out", o.out, "directory of the data set, seen by all nodes")->required();
  app.add_option("--shares", o.shares, "tasks of the array job")->check(CLI::Range(1, 100000))->capture_default_str();
  app.add_option("--cpus", o.cpus, "cores, and workers, a task")->check(CLI::Range(1, 1024))->capture_default_str();
  app.add_option("--sbatch", o.sbatch, "further option of sbatch, such as --sbatch=--partition=long");
}

int run(int argc, char** argv) {
  CLI::App app("Scenes of parts lying in a bin: poured, at rest, judged on their true meshes, seen by range cameras.");
  app.set_version_flag("--version", BIN_SCENES_VERSION);
  app.require_subcommand(1);

  GenerateOptions generate_options;
  CLI::App* generate_app = app.add_subcommand("generate", "make scenes from a request");
  add_generate(*generate_app, generate_options);

  InspectOptions inspect_options;
  CLI::App* inspect_app = app.add_subcommand("inspect", "what a model is, and how well its proxies fit it");
  add_inspect(*inspect_app, inspect_options);

  SymmetriesOptions symmetries_options;
  CLI::App* symmetries_app =
      app.add_subcommand("symmetries", "turns after which a part looks the same, as BOP lists them");
  add_symmetries(*symmetries_app, symmetries_options);

  SensorOptions sensor_options;
  CLI::App* sensor_app = app.add_subcommand("sensor", "what a sensor is worth: its noise, and how well it measures");
  add_sensor(*sensor_app, sensor_options);

  DatasetOptions dataset_options;
  CLI::App* dataset_app = app.add_subcommand("dataset", "make a data set from a plan; it goes on where it was stopped");
  add_dataset(*dataset_app, dataset_options);
  VerifyOptions verify_options;
  CLI::App* verify_app = dataset_app->add_subcommand("verify", "read a data set and check it against itself");
  verify_app->add_option("DIR", verify_options.directory, "directory of the data set");
  verify_app->add_flag("--list", verify_options.list, "what is checked");
  MergeOptions merge_options;
  CLI::App* merge_app = dataset_app->add_subcommand("merge", "join shares of a data set");
  merge_app->add_option("DIR", merge_options.shares, "directories of the shares")->required();
  merge_app->add_option("--out", merge_options.out, "directory of the whole data set")->required();

  ToolkitOptions toolkit_options;
  CLI::App* toolkit_app = dataset_app->add_subcommand(
      "toolkit", "entry of the data set for dataset_params.py of bop_toolkit; DIR/bop is its folder there");
  toolkit_app->add_option("DIR", toolkit_options.directory, "directory of the data set")->required();
  toolkit_app->add_option("--name", toolkit_options.name, "name that bop_toolkit shall know it by")->required();

  SubmitOptions submit_options;
  CLI::App* submit_app = dataset_app->add_subcommand("submit", "make a data set on a cluster: submit, watch, merge");
  add_submit(*submit_app, submit_options);

  ReportOptions report_options;
  CLI::App* report_app = app.add_subcommand("report", "a data set as one HTML page");
  report_app->add_option("DIR", report_options.directory, "directory of the data set")->required();
  report_app->add_option("--out", report_options.out, "HTML file; left out: DIR/report.html");

  AuditOptions audit_options;
  CLI::App* audit_app = app.add_subcommand(
      "audit", "how exact the scenes of any BOP data set are: overlap, free fall, drift, visible fractions");
  add_audit(*audit_app, audit_options);

  CLI::App* doctor_app = app.add_subcommand("doctor", "what of this machine can be used, and what is missing");
  CLI::App* reference_app = app.add_subcommand("reference", "docs/use/request.md")->group("");

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    const Error wrong = input_error(error.what(), "", "see bin_scenes --help");  // an argument may hold anything
    return complain(wrong.what(), static_cast<int>(wrong.kind()));
  }
  if (generate_app->parsed()) return generate(generate_options);
  if (inspect_app->parsed()) return inspect(inspect_options);
  if (symmetries_app->parsed()) return symmetries(symmetries_options);
  if (sensor_app->parsed()) return sensor(sensor_options);
  if (verify_app->parsed()) return dataset_verify(verify_options);
  if (merge_app->parsed()) return dataset_merge(merge_options);
  if (toolkit_app->parsed()) return dataset_toolkit(toolkit_options);
  if (submit_app->parsed()) return dataset_submit(submit_options);
  if (report_app->parsed()) return report(report_options);
  if (audit_app->parsed()) return audit(audit_options);
  if (dataset_app->parsed()) return dataset(dataset_options);
  if (doctor_app->parsed()) return doctor();
  if (reference_app->parsed()) std::cout << request_reference();
  return exit_done;
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  try {
    return run(argc, argv);
  } catch (const PlanErrors& errors) {
    for (const Error& error : errors.all()) complain(error.what(), 0);
    return static_cast<int>(errors.kind());
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::cancelled) {
      std::signal(SIGALRM, SIG_IGN);  // the patience of stop_on_signals(): it would say so once more
      _exit(complain("cancelled; finished scenes are kept", exit_interrupted));
    }
    return complain(error.what(), static_cast<int>(error.kind()));
  } catch (const std::bad_alloc&) {
    return complain("out of memory (ask for less, or lower memory_budget to be told before)",
                    static_cast<int>(ErrorKind::environment));
  } catch (const std::exception& error) {
    const Error defect = environment_error(error.what(), "unexpected", "");
    return complain(defect.what(), static_cast<int>(defect.kind()));
  }
}
