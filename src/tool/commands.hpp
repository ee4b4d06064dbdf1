/// The commands of the command line. Each takes its parsed options and returns the exit code. They throw Error.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// Exit codes in addition to those of errors: 2 for input errors and 3 for environment errors.
enum ExitCode { exit_done = 0, exit_set_apart = 1, exit_interrupted = 130 };  ///< 130: SIGINT or SIGTERM, as shells say

struct GenerateOptions {
  std::string request, out;
  std::optional<std::string> seed, scenes, first, solver, seconds;  ///< replace keys of the request, like --set
  std::vector<std::string> set;
  std::vector<std::string> formats = {"json"};
  std::optional<std::string> mcap;  ///< profile of MCAP files; none: ros1
  std::string trace;                ///< file of the trace; empty: none
  double trace_rate = 100;          ///< samples per second of simulated time (Hz)
  bool overwrite = false;
  bool verify = false;  ///< reads all files of the existing scenes
  bool verbose = false;
};
int generate(const GenerateOptions& options);

struct NewOptions {
  std::string part, unit, solid, sensor;  ///< sensor: name of a preset; empty: an ideal camera
  std::optional<double> thickness;        ///< thickness (m) of the walls of an open surface
  std::size_t count = 80;
  std::string out = "request.yaml";
  bool pour = true, overwrite = false;
};
int new_request(const NewOptions& options);

struct InspectOptions {
  std::string model, unit, solid;
  std::optional<double> chord, angle;  ///< tessellation: chord error (m), angle (rad)
  std::string hulls;                   ///< OBJ file for the convex hulls; empty: none
  bool json = false;
};
int inspect(const InspectOptions& options);

struct SymmetriesOptions {
  std::string model, unit, solid;
  std::optional<double> tolerance_mm;  ///< tolerance (mm); none: 1 % of the size of the part
  std::string picture;                 ///< PNG file; empty: none
  bool json = false;
};
int symmetries(const SymmetriesOptions& options);

struct SensorOptions {
  std::string sensor;  ///< name of a preset, or a file of sensor keys
  std::string plot;    ///< SVG file; empty: none
  bool json = false;
};
int sensor(const SensorOptions& options);

struct RealismOptions {
  std::vector<std::string> files;               ///< files of a real camera
  std::string request, sensor;                  ///< sensor of the request; empty: its first one
  std::string focal;                            ///< focal length (pixels); empty: that of the sensor
  std::string scale = "0.001", unit = "0.001";  ///< scale: m per count of depth; unit: rounding step (m)
  std::vector<std::string> crop, set;
  bool json = false;
};
int realism(const RealismOptions& options);

struct DatasetOptions {
  std::string plan, out;
  std::size_t workers = 0;  ///< number of worker processes; 0: one per core
  std::string shard;        ///< share of heaps as "i/n"; empty: all heaps
  bool json_progress = false;
};
int dataset(const DatasetOptions& options);

struct VerifyOptions {
  std::string directory;
  bool list = false;  ///< prints the invariants and checks nothing
};
int dataset_verify(const VerifyOptions& options);

struct MergeOptions {
  std::vector<std::string> shares;
  std::string out;
};
int dataset_merge(const MergeOptions& options);

struct ToolkitOptions {
  std::string directory, name;
};
/// Prints the settings of a data set for bop_toolkit, to be pasted into its code.
int dataset_toolkit(const ToolkitOptions& options);

struct SubmitOptions {
  std::string plan, out;
  std::size_t shares = 4, cpus = 1;
  std::vector<std::string> sbatch;  ///< further options of sbatch
};
int dataset_submit(const SubmitOptions& options);

struct AuditOptions {
  std::string directory, sensor, models;
  std::string bin, up;              ///< bin also "fitted"; empty: not given
  std::optional<double> floor;      ///< height of the floor (m)
  std::size_t most = 0;             ///< largest number of heaps; 0: all
  std::vector<std::string> limits;  ///< limits as "key=value"
  double share = 0.05;              ///< share of the parts that may exceed a limit of overlap, gap or drift
  std::string out;                  ///< HTML file of the report; empty: none
  bool json = false;
};
int audit(const AuditOptions& options);

struct ReferenceOptions {
  bool scene = false, json_schema = false;
};

struct ReportOptions {
  std::string directory;
  std::string out;  ///< HTML file; empty: report.html in the directory
};
int report(const ReportOptions& options);

struct ViewOptions {
  std::string scene;   ///< its folder, or its scene.json
  std::string models;  ///< folder of the model files; empty: they are beside or above the scene
  std::string trace;   ///< .jsonl file of `generate --trace`; empty: none
  std::string out;     ///< HTML file; empty: view.html in the folder
};
int view(const ViewOptions& options);

int doctor();

}  // namespace bin_scenes
