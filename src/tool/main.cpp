/// bin_scenes: the command line.
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
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
  app.add_option("--formats", o.formats, "of json, pcd, png, bop, bag; scene.json is always written")->delimiter(',');
  app.add_option("--set", o.set, "key=value: overrides any key of the request by its path");
  app.add_option("--seconds", o.seconds, "simulate exactly this long instead of until rest");
  app.add_option("--trace", o.trace, "CSV file with pose and velocity of each part over simulated time");
  app.add_option("--trace-rate", o.trace_rate, "rows a second and part")->capture_default_str();
  app.add_flag("--overwrite", o.overwrite, "make scenes anew that are there already");
  app.add_flag("--verify", o.verify,
               "read scenes that are there already and make those anew whose files have changed (else only sizes count)");
  app.add_flag("--verbose", o.verbose, "stage times and counters of each scene");
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
  inspect_app->add_option("MODEL", inspect_options.model, "mesh file")->required();
  inspect_app->add_option("--unit", inspect_options.unit, "unit of the file: m, cm, mm or inch");
  inspect_app->add_option("--hulls", inspect_options.hulls,
                          "OBJ file to write the convex hulls to, an object each (m)");
  inspect_app->add_flag("--json", inspect_options.json, "as JSON");

  SensorOptions sensor_options;
  CLI::App* sensor_app = app.add_subcommand("sensor", "what a sensor is worth: its noise, and how well it measures");
  sensor_app->add_option("SENSOR", sensor_options.sensor, "name of a preset, or a file of sensor keys")->required();
  sensor_app->add_option("--plot", sensor_options.plot, "SVG file: predicted noise over incidence and albedo");
  sensor_app->add_flag("--json", sensor_options.json, "as JSON");

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
  if (sensor_app->parsed()) return sensor(sensor_options);
  if (doctor_app->parsed()) return doctor();
  if (reference_app->parsed()) std::cout << request_reference();
  return exit_done;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::cancelled) {
      std::signal(SIGALRM, SIG_IGN);  // the patience of generate(): it would say so once more
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
