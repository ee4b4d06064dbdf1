/// bin_scenes: the command line.
#include "bin_scenes/config/plan.hpp"
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/config/scene_file.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/freed_memory.hpp"
#include "tool/commands.hpp"
#include "tool/completion.hpp"

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <new>
#include <vector>

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
  app.add_option("--formats", o.formats, "of " + format_names("and") + "; scene.json is always written")
      ->delimiter(',');
  app.add_option("--mcap", o.mcap, "whose messages the format mcap holds: ros1, as without it, or ros2");
  app.add_option("--set", o.set, "key=value: overrides any key of the request by its path");
  app.add_option("--seconds", o.seconds, "simulate exactly this long instead of until rest");
  app.add_option(
      "--trace", o.trace,
      "file with each part over simulated time: .csv (pose and velocity); with the contacts: .jsonl for view --trace, "
      ".bag or .mcap for RViz and Foxglove");
  app.add_option("--trace-rate", o.trace_rate, "rows a second and part")->capture_default_str();
  app.add_flag("--overwrite", o.overwrite, "generate scenes again that exist already");
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
  app.add_flag("--json-progress", o.json_progress, "progress as lines of JSON on standard output");
}

void add_audit(CLI::App& app, AuditOptions& o) {
  app.add_option("DIR", o.directory, "a data set, one of its splits, or one scene")->required();
  app.add_option(
      "--bin", o.bin,
      "inner size x,y,z (m) of a bin around the world's origin, floor at z = 0; or fitted: as wide as each heap");
  app.add_option("--floor", o.floor, "height (m) of a table; left out, without --bin: fitted to the lowest parts");
  app.add_option("--up", o.up, "x,y,z: up in the set's world, or in the camera's frame where the set states no world");
  app.add_option("--sensor", o.sensor, "of a set with several; left out: the first one");
  app.add_option("--models", o.models, "folder of the models; left out: models beside or above the scenes");
  app.add_option("--most", o.most, "heaps to audit; left out: all");
  app.add_option("--limit", o.limits, "KEY=VALUE: another limit of a measure, by the key that the table shows");
  app.add_option("--share", o.share, "share of the parts that may exceed limits of overlap, fall, drift and visibility")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--out", o.out, "HTML file with the table and a histogram of each measure");
  app.add_flag("--json", o.json, "print the result as JSON");
}

void add_new(CLI::App& app, NewOptions& o) {
  app.add_option("PART", o.part, "mesh or CAD file")->required();
  app.add_option("--count", o.count, "number of parts")->capture_default_str();
  app.add_option("--sensor", o.sensor, "name of a preset; left out: an ideal camera");
  app.add_option("--unit", o.unit, "unit of the file: m, cm, mm or inch; left out: as the file states, or guessed");
  app.add_option("--solid", o.solid, "of a STEP or IGES file with several");
  app.add_option("--thickness", o.thickness, "m: makes a shell of an open surface");
  app.add_option("--out", o.out, "file of the request; its first scene lies beside it")->capture_default_str();
  app.add_flag("!--no-pour", o.pour, "write the request alone");
  app.add_flag("--overwrite", o.overwrite, "replace a request that is there");
}

void add_inspect(CLI::App& app, InspectOptions& o) {
  app.add_option("MODEL", o.model, "mesh or CAD file")->required();
  app.add_option("--unit", o.unit, "unit of the file: m, cm, mm or inch");
  app.add_option("--solid", o.solid, "of a STEP or IGES file with several");
  app.add_option("--chord", o.chord, "m: largest distance of triangles from the surface of a STEP or IGES file");
  app.add_option("--angle", o.angle, "rad: between neighbouring triangles of its curved surfaces");
  app.add_option("--hulls", o.hulls, "OBJ file to write the convex hulls to, an object each (m)");
  app.add_flag("--json", o.json, "print the result as JSON");
}

void add_symmetries(CLI::App& app, SymmetriesOptions& o) {
  app.add_option("PART", o.model, "mesh or CAD file")->required();
  app.add_option("--unit", o.unit, "unit of the file: m, cm, mm or inch");
  app.add_option("--solid", o.solid, "of a STEP or IGES file with several");
  app.add_option("--tolerance", o.tolerance_mm,
                 "mm that surfaces may lie apart; left out: a hundredth of the part's size");
  app.add_option("--picture", o.picture, "PNG file of the part with its axes");
  app.add_flag("--json", o.json, "print the result as JSON");
}

void add_sensor(CLI::App& app, SensorOptions& o) {
  app.add_option("SENSOR", o.sensor, "name of a preset, or a file of sensor keys")->required();
  app.add_option("--plot", o.plot, "SVG file: predicted noise over distance, incidence and albedo");
  app.add_flag("--json", o.json, "print the result as JSON");
}

void add_realism(CLI::App& app, RealismOptions& o) {
  app.add_option("REAL", o.files, "depth of a real camera: PLY or PCD clouds, or 16-bit PNG")->required();
  app.add_option("--request", o.request, "request of similar scenes, with the sensor to compare")->required();
  app.add_option("--sensor", o.sensor, "of a request with several; left out: the first one");
  app.add_option("--focal", o.focal, "focal length of the real camera, pixel; left out: that of the sensor");
  app.add_option("--scale", o.scale, "m per count of the real camera's PNG files")->capture_default_str();
  app.add_option("--unit", o.unit, "m to which all depths are rounded before; 0: not")->capture_default_str();
  app.add_option("--crop", o.crop, "left, top, width and height (pixel) of the region that is compared in all images")
      ->expected(4);
  app.add_option("--set", o.set, "key=value: overrides any key of the request by its path");
  app.add_flag("--json", o.json, "print the result as JSON");
}

void add_submit(CLI::App& app, SubmitOptions& o) {
  app.add_flag("--slurm")->group("");  // accepted, as it was needed once
  app.add_option("PLAN", o.plan, "plan of the data set")->required();
  app.add_option("--out", o.out, "directory of the data set, seen by all nodes")->required();
  app.add_option("--shares", o.shares, "tasks of the array job")->check(CLI::Range(1, 100000))->capture_default_str();
  app.add_option("--cpus", o.cpus, "cores, and workers, a task")->check(CLI::Range(1, 1024))->capture_default_str();
  app.add_option("--sbatch", o.sbatch, "further option of sbatch, such as --sbatch=--partition=long");
}

void add_reference(CLI::App& app, ReferenceOptions& o) {
  app.add_flag("--scene", o.scene, "docs/use/scene.md instead of docs/use/request.md");
  app.add_flag("--json-schema", o.json_schema, "JSON schema of requests, for editors");
}

void add_verify(CLI::App& app, VerifyOptions& o) {
  app.add_option("DIR", o.directory, "directory of the data set");
  app.add_flag("--list", o.list, "what is checked");
}

void add_merge(CLI::App& app, MergeOptions& o) {
  app.add_option("DIR", o.shares, "directories of the shares")->required();
  app.add_option("--out", o.out, "directory of the whole data set")->required();
}

void add_toolkit(CLI::App& app, ToolkitOptions& o) {
  app.add_option("DIR", o.directory, "directory of the data set")->required();
  app.add_option("--name", o.name, "name that bop_toolkit shall know it by")->required();
}

void add_report(CLI::App& app, ReportOptions& o) {
  app.add_option("DIR", o.directory, "directory of the data set")->required();
  app.add_option("--out", o.out, "HTML file; left out: DIR/report.html");
}

void add_view(CLI::App& app, ViewOptions& o) {
  app.add_option("SCENE", o.scene, "folder of a scene, or its scene.json")->required();
  app.add_option("--models", o.models, "folder of the models, if they are neither beside nor above the scene");
  app.add_option("--trace", o.trace, "a .jsonl file of generate --trace: shows the scene over time, with its contacts");
  app.add_option("--out", o.out, "HTML file; left out: SCENE/view.html");
}

struct CompletionOptions {
  std::string shell;
};

struct Command {
  CLI::App* app;
  std::function<int()> run;
};

class Commands {
 public:
  template <class Options>
  CLI::App& add(CLI::App& app, int (*run)(const Options&), const char* name, const char* text,
                void (*add_options)(CLI::App&, Options&)) {
    CLI::App* command = app.add_subcommand(name, text);
    const auto options = std::make_shared<Options>();
    add_options(*command, *options);
    all_.push_back({command, [=] { return run(*options); }});
    return *command;
  }
  CLI::App& add(CLI::App& app, const std::function<int()>& run, const char* name, const char* text) {
    all_.push_back({app.add_subcommand(name, text), run});
    return *all_.back().app;
  }
  /// The command that was named: of a command and its own, the one that was added last.
  int run() const {
    const auto named = std::find_if(all_.rbegin(), all_.rend(), [](const Command& c) { return c.app->parsed(); });
    return named == all_.rend() ? exit_done : named->run();
  }

 private:
  std::vector<Command> all_;
};

void add_completion(CLI::App& app, CompletionOptions& o) {
  app.add_option("SHELL", o.shell, "bash or zsh")->required();
}

int print_completion(const CompletionOptions& options) {
  std::cout << completion_script(options.shell);
  return exit_done;
}

int print_reference(const ReferenceOptions& options) {
  std::cout << (options.json_schema ? request_json_schema() : options.scene ? scene_reference() : request_reference());
  return exit_done;
}

void add_commands(CLI::App& app, Commands& all) {
  all.add(app, new_request, "new", "a first request for a part: bin, sensor and comments; pours it once", add_new);
  all.add(app, generate, "generate", "make scenes from a request", add_generate);
  all.add(app, inspect, "inspect", "what a model is, and how well its proxies fit it", add_inspect);
  all.add(app, symmetries, "symmetries", "turns after which a part looks the same, as BOP lists them", add_symmetries);
  all.add(app, sensor, "sensor", "what a sensor is worth: its noise, and how well it measures", add_sensor);
  all.add(app, realism, "realism", "how a simulated sensor differs from a real camera's files, and which keys move it",
          add_realism);
  CLI::App& set =
      all.add(app, dataset, "dataset", "make a data set from a plan; it goes on where it was stopped", add_dataset);
  all.add(set, dataset_verify, "verify", "read a data set and check it against itself", add_verify);
  all.add(set, dataset_merge, "merge", "join shares of a data set", add_merge);
  all.add(set, dataset_toolkit, "toolkit",
          "entry of the data set for dataset_params.py of bop_toolkit; DIR/bop is its folder there", add_toolkit);
  all.add(set, dataset_submit, "submit", "make a data set on a cluster: submit, watch, merge", add_submit);
  all.add(app, report, "report", "a data set as one HTML page", add_report);
  all.add(app, view, "view", "a scene as one HTML page: parts, clouds, cameras, report", add_view);
  all.add(app, audit, "audit",
          "how exact the scenes of any BOP data set are, and which parts and images are not: overlap, drift, masks, "
          "depth, cameras; exit code 1 if limits are exceeded",
          add_audit);
  all.add(app, doctor, "doctor", "what of this machine can be used, and what is missing");
  all.add(app, print_completion, "completion", "script of completion for a shell: source <(bin_scenes completion bash)",
          add_completion);
  all.add(app, print_reference, "reference", "keys of requests and of scene.json", add_reference);
}

int run(int argc, char** argv) {
  CLI::App app("Scenes of parts lying in a bin: poured, at rest, judged on their true meshes, seen by range cameras.");
  app.set_version_flag("--version", BIN_SCENES_VERSION);
  app.require_subcommand(1);
  Commands commands;
  add_commands(app, commands);
  if (argc > 2 && argv[1] == std::string("complete")) {  // asked by a shell: bin_scenes complete -- WORDS
    for (const std::string& word : completions(app, {argv + 3, argv + argc})) std::cout << word << "\n";
    return exit_done;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    const Error wrong = input_error(error.what(), "", "see bin_scenes --help");  // an argument may hold anything
    return complain(wrong.what(), static_cast<int>(wrong.kind()));
  }
  return commands.run();
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
    return complain("out of memory (ask for less, or lower memory_budget to learn it beforehand)",
                    static_cast<int>(ErrorKind::environment));
  } catch (const std::exception& error) {
    const Error defect = environment_error(error.what(), "unexpected", "");
    return complain(defect.what(), static_cast<int>(defect.kind()));
  }
}
