// The `depthgrid` program: arguments in, exit code out. CLI11 is slow to compile and is included
// here, in usage and in common_options only.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <sstream>

#include "eval/cli/commands.h"
#include "eval/cli/common_options.h"
#include "eval/cli/complaint.h"
#include "eval/cli/console.h"
#include "eval/cli/interrupts.h"
#include "eval/cli/usage.h"
#include "eval/output/build_id.h"

namespace depthgrid::cli {
namespace {

constexpr const char* kFirstSteps =
    "First steps:\n"
    "  depthgrid scenes                     what is shipped\n"
    "  depthgrid run living_room -o out     a minute; then open out/report.html\n"
    "  depthgrid COMMAND --help             options and examples of a command\n"
    "Exit codes: 0 done, 1 failed while running, 2 bad usage or input, 130 ended by Ctrl-C,\n"
    "143 by kill, 129 by a closed terminal, 141 when nobody reads what it prints.";

struct Program {
  CLI::App app{"depthgrid: 2D navigation maps from RGB-D cameras, simulated and recorded",
               "depthgrid"};
  std::function<void()> chosen;

  // Adds a subcommand whose arguments live as long as the program.
  template <typename Arguments>
  std::pair<CLI::App*, std::shared_ptr<Arguments>> Add(CLI::App& parent, const std::string& name,
                                                       const std::string& what,
                                                       const std::string& example,
                                                       void (*run)(const Arguments&)) {
    CLI::App* command = parent.add_subcommand(name, what);
    command->footer("Example:\n  " + example);
    auto arguments = std::make_shared<Arguments>();
    command->callback([this, arguments, run] { chosen = [arguments, run] { run(*arguments); }; });
    return {command, arguments};
  }
};

void AddScenes(Program& program) {
  const auto [app, arguments] = program.Add<ScenesArguments>(
      program.app, "scenes", "List what is shipped; or describe one scene and draw its plan",
      "depthgrid scenes\n"
      "  depthgrid scenes ./mine.yaml --plan plan.png   # its floor, its paths, what is wrong",
      &ListScenes);
  app->add_option("scene", arguments->scene, "Shipped scene, or a scene or mesh file");
  app->add_option("--plan", arguments->plan,
                  "Picture (PNG) to draw: the scene from above, its paths, lines at whole metres")
      ->type_name("FILE");
  app->add_flag("--force", arguments->force, "Replace a picture of that name");
}

void AddRender(Program& program) {
  const auto [app, arguments] = program.Add<RenderArguments>(
      program.app, "render",
      "Render a scene to a TUM RGB-D folder, with the true map and which of its cells can be seen",
      "depthgrid render living_room -o /tmp/living_room", &Render);
  app->add_option("scene", arguments->scene, "Shipped scene or experiment, or a file")->required();
  app->add_flag("--no-colour", arguments->no_colour, "Depth images only: several times as fast");
  AddOutput(*app, arguments->common);
  AddSet(*app, arguments->common, kSetOfExperimentMeaning);
  AddThreads(*app, arguments->common);
  AddCache(*app, arguments->common);
}

void AddSlamFiles(CLI::App& app, MapArguments& arguments) {
  app.add_option("--poses", arguments.poses,
                 "SLAM's live poses (TUM, EuRoC, VINS, RTAB-Map, KITTI); default: the folder's own")
      ->type_name("FILE");
  app.add_option("--final-poses", arguments.final_poses,
                 "SLAM's poses after all corrections; without --loops, loops are derived from them")
      ->type_name("FILE");
  app.add_option("--loops", arguments.loops,
                 "SLAM's events: loops.csv of `depthgrid slam`, ORB-SLAM2's, or stamped loops")
      ->type_name("FILE");
}

void AddMap(Program& program) {
  const auto [app, arguments] = program.Add<MapArguments>(
      program.app, "map", "Map a recorded or rendered sequence",

      "depthgrid map robot.log -o /tmp/out                  # a laser log brings its odometry\n"
      "  depthgrid map rgbd_folder --poses slam.txt -o /tmp/out\n"
      "  depthgrid map rgbd_folder --poses live.txt --loops loops.csv -o /tmp/out",
      &Map);
  app->add_option(
         "input", arguments->input,
         "A TUM, ICL-NUIM or frame-by-frame folder, a CARMEN laser log, or the run.yaml of a "
         "map, which is made again")
      ->required();
  AddSlamFiles(*app, *arguments);
  app->add_option("--format", arguments->format,
                  "Kind of the input, which is otherwise detected: tum, icl, frames, carmen")
      ->type_name("KIND");
  app->add_option("--camera", arguments->camera, "A camera file in place of the folder's own")
      ->type_name("FILE");
  app->add_option("--up", arguments->world_up,
                  "Axis of the poses' world that points up: x, -x, y, -y, z, -z or auto")
      ->type_name("AXIS");
  app->add_option(
         "--map", arguments->map,
         "Continue the finished map of this run's folder: its scans stay, new ones are added")
      ->type_name("DIR");
  app->add_option("--start", arguments->start,
                  "With --map: where in that map the sequence begins, m and degrees, within 12 "
                  "degrees; default: it is searched for")
      ->type_name("X,Y,YAW_DEG")
      ->check(RefusalUnlessPlace);
  app->add_option("--start-within", arguments->start_within,
                  "How far off --start may be, m (default 1.5); 0 takes it as it is")
      ->type_name("M");
  app->add_flag("--localise", arguments->localise,
                "With --map: find the poses in that map and leave it as it is")
      ->needs("--map");
  AddOutput(*app, arguments->common);
  AddOutputForms(*app, arguments->output);
  AddSet(*app, arguments->common);
  AddKeys(*app, &MapKeys);
}

void AddRun(Program& program) {
  const auto [app, arguments] = program.Add<RunArguments>(
      program.app, "run", "Render, disturb, map and score one experiment, in memory",

      "depthgrid run living_room -o /tmp/out                # then open /tmp/out/report.html\n"
      "  depthgrid run office_room -o /tmp/out2 --set mapper.fusion.gain=0.25 --set seed=7\n"
      "  depthgrid run mine.yaml -o /tmp/out3                 # only `scene:` is required in it\n"
      "  depthgrid run living_room --keys                     # what can be set",
      &Run);
  app->add_option("experiment", arguments->experiment, "Shipped experiment or a YAML file")
      ->required();
  AddOutput(*app, arguments->common);
  AddOutputForms(*app, arguments->output);
  AddSet(*app, arguments->common);
  AddThreads(*app, arguments->common);
  AddCache(*app, arguments->common);
  AddKeys(*app, &ExperimentKeys);
}

void AddSweep(Program& program) {
  const auto [app, arguments] = program.Add<SweepArguments>(
      program.app, "sweep",
      "Run an experiment for many settings and seeds; started again, it continues where it stopped",
      "depthgrid sweep kalman_gain -o /tmp/gains", &Sweep);
  app->add_option("sweep", arguments->sweep, "Shipped sweep or a YAML file");
  app->add_option("-j,--jobs", arguments->jobs, "Runs at a time; 0: one per core")
      ->type_name("N")
      ->check(CLI::Range(0, 1024).description(""));
  app->add_option("--shard", arguments->shard, "Do only part I of N, counted from 1")
      ->type_name("I/N");
  app->add_option("--merge", arguments->merge, "Join the parts in these folders into one table")
      ->type_name("DIR");
  app->add_option("--reuse", arguments->reuse, "Take runs of the same values from it (repeatable)")
      ->type_name("DIR")
      ->allow_extra_args(false);
  app->add_option("--executor", arguments->executor, "Where runs are done")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  app->add_option("--slurm-options", arguments->slurm_options,
                  "More options for sbatch, such as '--partition=long --time=1:00:00'");
  app->add_option("--slurm-tasks", arguments->slurm_tasks,
                  "Number of parts; 0 gives each at least 30 s of work")
      ->check(CLI::Range(0, 1000));
  app->add_flag("--dry-run", arguments->dry_run, "Say how many runs and how long, then stop");
  AddOutput(*app, arguments->common,
            "Begin in a folder that holds other files, which stay; never in one that holds another "
            "result or files named as a sweep's are");
  AddSet(*app, arguments->common);
  AddCache(*app, arguments->common);
  AddKeys(*app, &ExperimentKeys);
}

void AddSlam(Program& program) {
  const auto [app, arguments] = program.Add<SlamArguments>(
      program.app, "slam", "Disturb a sequence's true trajectory as a SLAM system would",
      "depthgrid slam /tmp/living_room --profile orb_slam2 --seed 1 -o /tmp/slam", &Slam);
  app->add_option("sequence", arguments->sequence,
                  "A TUM folder with depth.txt and groundtruth.txt")
      ->required();
  app->add_option("--profile", arguments->profile, "Which system, as slam.profile of an experiment")
      ->capture_default_str();
  AddSeed(*app, "--seed", arguments->seed, "Seed of the errors");
  AddOutput(*app, arguments->common);
  AddSet(*app, arguments->common,
         "Override a key, slam.NAME=value (repeat for more); `depthgrid run --keys` lists them");
}

void AddSlamCalibrate(Program& program) {
  const auto [app, arguments] = program.Add<SlamCalibrateArguments>(
      program.app, "slam-calibrate",
      "Find the slam.drift_scale that gives a wanted mean error of the live poses",
      "depthgrid slam-calibrate living_room --set slam.profile=orb_slam2 --target 0.407",
      &SlamCalibrate);
  app->add_option("experiment", arguments->experiment, "Shipped experiment or scene, or a file")
      ->required();
  app->add_option("--target", arguments->target_m, "Mean distance to the truth in xy, metres")
      ->required()
      ->check(RefusalUnlessPositive);
  app->add_option("--seeds", arguments->seeds, "How many runs to average")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  AddSeed(*app, "--first-seed", arguments->first_seed, "Seed of the first run");
  AddSet(*app, arguments->common, kSetOfExperimentMeaning);
  AddThreads(*app, arguments->common);
}

void AddSlamFit(Program& program) {
  const auto [app, arguments] = program.Add<SlamFitArguments>(
      program.app, "slam-fit", "Find the slam settings that describe recorded SLAM runs",
      "depthgrid slam-fit groundtruth.txt live.txt", &FitSlam);
  app->add_option("files", arguments->files, "Pairs of TUM files: truth, estimate as given live")
      ->required()
      ->expected(2, 1000);
}

void AddEvalTrajectory(Program& program, CLI::App& eval) {
  const auto [app, arguments] = program.Add<EvalTrajectoryArguments>(
      eval, "trajectory", "Errors of a trajectory, TUM or KITTI files, evo's conventions",
      "depthgrid eval trajectory groundtruth.txt trajectory_est.txt", &EvalTrajectory);
  app->add_option("reference", arguments->reference, "True trajectory")->required();
  app->add_option("estimate", arguments->estimate, "Estimated trajectory")->required();
  app->add_option("--max-difference", arguments->max_difference_s,
                  "Stamps nearer than this belong together, seconds (evo 0.01, tum 0.02)")
      ->check(RefusalIfNegative);
  app->add_option("--time-offset", arguments->time_offset_s,
                  "Added to the estimate's stamps, seconds, where its clock differs")
      ->check(RefusalUnlessFinite);
  app->add_option("--convention", arguments->convention,
                  "How poses are paired: evo (nearest) or tum (as its scripts do: each pose once)")
      ->check(CLI::IsMember({"evo", "tum"}))
      ->capture_default_str();
  app->add_option("--errors", arguments->errors,
                  "Write the errors over time to this CSV, not aligned")
      ->type_name("FILE");
  app->add_flag("--force", arguments->force,
                "Replace that file if it exists, but never one of the trajectories");
  app->add_flag("--json", arguments->json, "Print JSON instead of a table");
}

void AddEvalMap(Program& program, CLI::App& eval) {
  const auto [app, arguments] = program.Add<EvalMapArguments>(
      eval, "map", "Agreement of a map with the true one, Nav2 YAML files",
      "depthgrid eval map OUT/truth_map.yaml OUT/map.yaml", &EvalMap);
  app->add_option("reference", arguments->reference, "True map")->required();
  app->add_option("estimate", arguments->estimate, "Estimated map")->required();
  app->add_option("--observable", arguments->observable,
                  "Map whose free cells are those that could be seen; default: observable.yaml "
                  "beside the true map")
      ->type_name("FILE");
  app->add_flag("--json", arguments->json, "Print JSON instead of a table");
}

void AddEval(Program& program) {
  CLI::App* eval = program.app.add_subcommand("eval", "Score a trajectory or a map");
  eval->require_subcommand(1);
  eval->footer(
      "Example:\n  depthgrid eval trajectory groundtruth.txt trajectory_est.txt\n"
      "  depthgrid eval map OUT/truth_map.yaml OUT/map.yaml --json");
  AddEvalTrajectory(program, *eval);
  AddEvalMap(program, *eval);
}

void AddCompare(Program& program) {
  const auto [app, arguments] = program.Add<CompareArguments>(
      program.app, "compare", "Which of two sweeps or sets of runs is better, and how sure that is",
      "depthgrid compare sweep sweep --where-a mapper.fusion.gain=0.2 "
      "--where-b mapper.fusion.gain=1",
      &CompareRuns);
  const auto add_where = [&app = app](const char* name, std::vector<std::string>& values,
                                      const char* meaning) {
    app->add_option(name, values, meaning)->type_name("KEY=VALUE")->allow_extra_args(false);
  };
  app->add_option("a", arguments->a, "A sweep's folder, a run's, or a folder of runs")->required();
  app->add_option("b", arguments->b, "Likewise; runs of the same seeds are paired")->required();
  app->add_option("--metric", arguments->metrics,
                  "A score by its path in metrics.json (repeat for more), or all")
      ->type_name("NAME")
      ->allow_extra_args(false);
  add_where("--where", arguments->where, "Only runs with this value of an axis (repeat for more)");
  add_where("--where-a", arguments->where_a, "Likewise, for A alone");
  add_where("--where-b", arguments->where_b, "Likewise, for B alone");
  app->add_flag("--json", arguments->json, "Print JSON instead of a table");
}

void AddAblate(Program& program) {
  const auto [app, arguments] = program.Add<AblateArguments>(
      program.app, "ablate",
      "Replace each stage in turn by the truth: how much of the error is due to each",
      "depthgrid ablate living_room --seeds 10 -o /tmp/ablation", &Ablate);
  app->add_option("experiment", arguments->experiment, "Shipped experiment or a YAML file")
      ->required();
  app->add_option("--seeds", arguments->seeds, "Number of seeds; fewer than 8 prove nothing")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  AddSeed(*app, "--first-seed", arguments->first_seed, "The first seed");
  app->add_flag("--json", arguments->json, "Print JSON instead of tables");
  AddOutput(*app, arguments->common);
  AddSet(*app, arguments->common, kSetOfExperimentMeaning);
  AddThreads(*app, arguments->common);
  AddCache(*app, arguments->common);
}

void AddReport(Program& program) {
  const auto [app, arguments] =
      program.Add<ReportArguments>(program.app, "report", "Write a folder's HTML report (again)",
                                   "depthgrid report /tmp/out\n"
                                   "  depthgrid report /mnt/read_only/out -o /tmp/page",
                                   &Report);
  app->add_option("folder", arguments->folder,
                  "Folder that `run`, `map`, `sweep` or `ablate` wrote")
      ->required();
  MeantFolder(app->add_option("-o,--output", arguments->output,
                              "Folder for the page; default: the same one"))
      ->type_name("DIR");
  app->add_flag("--force", arguments->force, "Write into a folder that is not empty");
}

void AddRegrid(Program& program) {
  const auto [app, arguments] = program.Add<RegridArguments>(
      program.app, "regrid",
      "Draw a run's map again from its stored scans, as map_RESOLUTION.yaml beside the first",
      "depthgrid regrid /tmp/out --resolution 0.02", &Regrid);
  app->add_option("folder", arguments->folder, "Folder that `run` or `map` wrote")->required();
  app->add_option("--resolution", arguments->resolution, "Cell size, metres, from 0.005 to 1")
      ->required()
      ->type_name("FLOAT");
  AddMapMode(*app, arguments->map_mode);
  app->add_flag("--force", arguments->force, "Replace a map of that name");
}

// In the order in which --help lists them.
void AddCommands(Program& program) {
  AddScenes(program);
  AddRender(program);
  AddMap(program);
  AddRun(program);
  AddSweep(program);
  AddSlam(program);
  AddSlamCalibrate(program);
  AddSlamFit(program);
  AddEval(program);
  AddRegrid(program);
  AddCompare(program);
  AddAblate(program);
  AddReport(program);
}

// Rejects empty names, which are most likely an unset shell variable, and those that begin with ~.
void RequireNames(CLI::App& app) {
  const auto refusal = [](const std::string& name) {
    return name.empty() ? std::string("is empty") : RefusalOfTilde(name);
  };
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    const bool is_name = option->get_positional() || type == "FILE" || type == "DIR";
    if (is_name) option->check(CLI::Validator(refusal, ""));
  }
  for (CLI::App* command : app.get_subcommands({})) RequireNames(*command);
}

int Main(int argc, char** argv) {
  OpenStandardStreams();
  Program program;
  program.app.require_subcommand(1);
  program.app.set_version_flag("--version", VersionText());
  program.app.footer(kFirstSteps);
  AddCommands(program);
  RequireNames(program.app);
  CatchInterrupts();
  try {
    try {
      program.app.parse(argc, argv);
      program.chosen();
    } catch (const CLI::Success& asked) {  // --help, --keys, --version
      std::ostringstream text;
      program.app.exit(asked, text, text);
      fmt::print("{}", text.str());
    } catch (const CLI::ParseError& error) {
      return Complain(UsageMessage(program.app, error, {argv + 1, argv + argc}), kBadInput);
    }
    FinishOutput();
    return kDone;
  } catch (const std::exception& error) {
    return ComplainOf(error);
  }
}

}  // namespace
}  // namespace depthgrid::cli

int main(int argc, char** argv) { return depthgrid::cli::Main(argc, argv); }
