// scripts/dataset with programs that stand in for odis, sbatch and scontrol, and with GNU parallel where
// there is one.
#include "command_runner.h"

namespace {

using odis::test::Outcome;

// Makes a file a seed. It is ill at part 2 in the way that the file "ill" names: "always", or once.
constexpr const char* kOdis = R"sh(#!/usr/bin/env bash
set -eu
[[ $* == *--dry-run ]] && exit "$(cat refuse 2> /dev/null || echo 0)"
echo "$*" >> calls
[[ $2 == merge ]] && exec ls out/{5,6,7,8,9,10,11}.shard
part=${!#}
part=${part%-*}
if [[ $part == 2 && -e ill ]]; then
  mktemp > /dev/null
  ill=$(< ill)
  [[ $ill == *always ]] || rm ill
  trap 'exit 143' TERM
  case $ill in
    usage*) exit 2 ;;
    killed*) kill -9 $$ ;;
    time*) kill -USR1 $PPID ;;
    cancelled*) kill -TERM $PPID $$ ;;
  esac
  for i in {1..99}; do sleep 0.05; done
  exit 1
fi
for ((seed = 5 + 7 * (part - 1) / 3; seed < 5 + 7 * part / 3; ++seed)); do
  echo "$seed" > "out/$seed.shard"
done
)sh";

// Runs the tasks of a job one after another, and each again for as long as it asks scontrol for that.
constexpr const char* kSbatch = R"sh(#!/usr/bin/env bash
printf '%s\n' "$@" >> submitted
job=$(($(cat jobs || echo 40) + 1)) 2> /dev/null
echo $job > jobs
echo $job
parts=none
while [[ "$1" != */dataset-task ]]; do
  [[ "$1" =~ ^--array=1-([0-9]+) ]] && parts=$(seq "${BASH_REMATCH[1]}")
  shift
done
export SLURM_JOB_ID=7 SLURM_ARRAY_JOB_ID=7 SLURM_RESTART_COUNT SLURM_ARRAY_TASK_ID
for part in $parts; do
  SLURM_ARRAY_TASK_ID=${part/none/} SLURM_RESTART_COUNT=0
  while "$@" >> log 2>&1; [[ -e requeued ]]; do
    rm requeued
    SLURM_RESTART_COUNT=$((SLURM_RESTART_COUNT + 1))
  done
done
)sh";

class Cluster : public odis::test::Odis {
 protected:
  void SetUp() override {
    Odis::SetUp();
    std::filesystem::create_directory(file("bin"));
    std::filesystem::create_directory(file("tmp"));
    program("bin/sbatch", kSbatch);
    program("bin/scontrol", "#!/bin/sh\n[ \"$*\" = 'requeue 7_2' ] && touch requeued\n");
    program("odis", kOdis);
  }
  void program(const std::string& name, const std::string& text) const {
    write(name, text);
    std::filesystem::permissions(file(name), std::filesystem::perms::owner_all);
  }
  Outcome script(const std::string& arguments) const {
    return runShell("export TMPDIR=\"$PWD/tmp\" PATH=\"$PWD/bin:$PATH\"; '" ODIS_SOURCE "/scripts/dataset' " +
                    arguments);
  }
  // A data set of seven seeds in three parts.
  Outcome make(const std::string& engine, const std::string& options = "") const {
    return script(engine + " --parts 3 --cpus 4 " + options +
                  " ./odis -- --seeds 5-11 -o out --hdri 'a  \"$b'");
  }
  std::string output(const std::string& command) const { return runShell(command).text; }
  // Which parts were begun, in their order.
  std::string parts() const { return output("sed -n 's/.*generate.*-//p' calls | tr -d '\\n'"); }
  void forget() const { runShell("rm -rf out calls submitted jobs log ill"); }
};

constexpr const char* kGenerate =
    "dataset generate --seeds 5-11 -o out --hdri a  \"$b --jobs 4 --of 3 --shards 1-1\n";
constexpr const char* kMerge = "dataset merge out --seeds 5-11 --quiet\n";

TEST_F(Cluster, SlurmGetsAnArrayAndAMerge) {
  const Outcome outcome = make("slurm", "--at-once 2 --time 1:00:00 --sbatch '--partition \"a b\" --mem=1G'");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("job 41 makes 3 parts, then job 42 merges"), std::string::npos) << outcome.text;
  EXPECT_EQ(output("sed -n '1p;$p' calls"), std::string(kGenerate) + kMerge);
  EXPECT_EQ(output("ls out/*.shard | wc -l"), "7\n");
  const std::string submitted = output("cat submitted");
  for (const std::string option :
       {"--array=1-3%2", "--cpus-per-task=4", "--requeue", "--signal=B:USR1@60",
        "--output=out/logs/part-%a.log", "--time=1:00:00", "--partition\na b\n--mem=1G",
        "--dependency=afterany:41", "--output=out/logs/merge.log"})
    EXPECT_NE(submitted.find("\n" + option + "\n"), std::string::npos) << option << " in:\n" << submitted;
}

TEST_F(Cluster, SlurmRunsATaskAgain) {
  struct Case {
    const char *ill, *parts;
  };
  // Not what is as wrong the next time, nor what was cancelled.
  for (const Case& c : {Case{"killed", "1223"}, Case{"time is up", "1223"}, Case{"killed always", "12223"},
                        Case{"usage always", "123"}, Case{"cancelled always", "123"}}) {
    write("ill", c.ill);
    EXPECT_EQ(make("slurm", "--retries 2").code, 0);
    EXPECT_EQ(parts(), c.parts) << c.ill << "\n" << output("cat log");
    EXPECT_EQ(output("tail -n 1 calls"), kMerge) << c.ill;
    EXPECT_EQ(output("ls tmp"), "") << c.ill;
    forget();
  }
}

TEST_F(Cluster, SlurmMakesADataSet) {
  const Outcome outcome = script("slurm --parts 2 '" ODIS_COMMAND "' -- --seeds 117-118 -o data --quick");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(run("dataset check data --quiet").code, 0) << output("cat log");
  EXPECT_EQ(output("ls data/*.shard | wc -l"), "2\n");
}

// Whatever the program refuses to make is not submitted.
TEST_F(Cluster, AsksTheProgramFirst) {
  write("refuse", "2");
  EXPECT_EQ(make("slurm").code, 2);
  EXPECT_FALSE(exists("submitted"));
  EXPECT_FALSE(exists("out"));
  const std::string odis = "slurm --parts 2 '" ODIS_COMMAND "' -- --seeds 117-118 -o data ";
  EXPECT_EQ(script(odis + "--quick").code, 0);
  std::filesystem::remove(file("submitted"));
  const Outcome outcome = script(odis + "--quality");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.text.find("shards are made with --seeds --quick"), std::string::npos) << outcome.text;
  EXPECT_FALSE(exists("submitted"));
}

TEST_F(Cluster, ParallelRunsATaskAgain) {
  if (runShell("parallel --version | grep -q GNU").code != 0) GTEST_SKIP() << "there is no GNU parallel";
  write("ill", "killed");
  const Outcome outcome = make("parallel", "--at-once 1");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(parts(), "1223");
  EXPECT_EQ(output("sed -n '1p;$p' calls"), std::string(kGenerate) + kMerge);
  EXPECT_EQ(output("ls out/*.shard | wc -l"), "7\n");
  // Without all parts there is no merge.
  forget();
  write("ill", "usage always");
  EXPECT_EQ(make("parallel", "--retries 1").code, 1);
  EXPECT_EQ(output("grep -c merge calls"), "0\n");
}

TEST_F(Cluster, SaysWhatIsWrong) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "slurm or parallel first"},
      {"pbs", "slurm or parallel first"},
      {"slurm", "expected -- and"},
      {"slurm -- --seeds 1-2 -o out", "expected the program"},
      {"slurm ./odis more -- --seeds 1-2 -o out", "found \"more\""},
      {"slurm ./absent -- --seeds 1-2 -o out", "\"./absent\" is no program"},
      {"slurm --parts 0 ./odis -- --seeds 1-2 -o out", "found \"0\""},
      {"slurm --parts 3 ./odis -- --seeds 1-2 -o out", "only 2 scenes"},
      {"slurm --parts -- --seeds 1-2 -o out", "--parts: expected a value"},
      {"slurm --colour ./odis -- --seeds 1-2 -o out", "--colour: no such option"},
      {"slurm --parallel --bar ./odis -- --seeds 1-2 -o out", "option of parallel"},
      {"parallel --time 10 ./odis -- --seeds 1-2 -o out", "option of slurm"},
      {"slurm ./odis -- -o out", "expected FIRST-LAST"},
      {"slurm ./odis -- --seeds 7-5 -o out", "no scene in 7-5"},
      {"slurm ./odis -- --scenes bin -o out", "no scene in bin"},
      {"slurm ./odis -- --seeds 1-2", "expected -o DIR"},
      {"slurm ./odis -- --seeds 1-2 -o", "-o: expected a value"},
      {"slurm ./odis -- --seeds 1-2 -o out --of 3", "--of comes from --parts"},
      {"slurm --sbatch \"it's\" ./odis -- --seeds 1-2 -o out", "the quotes in: it's"}};
  for (const auto& [arguments, message] : cases) {
    const Outcome outcome = script(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.text;
    EXPECT_NE(outcome.text.find(message), std::string::npos) << arguments << "\n" << outcome.text;
    EXPECT_FALSE(exists("out")) << arguments;
  }
  program("bin/sbatch", "#!/bin/sh\nexit 1\n");
  EXPECT_EQ(make("slurm").code, 1);
  const Outcome absent = runShell("bash=$(command -v bash); PATH=/; \"$bash\" '" ODIS_SOURCE
                                  "/scripts/dataset' parallel ./odis -- --seeds 1-2 -o out");
  EXPECT_EQ(absent.code, 5);
  EXPECT_NE(absent.text.find("parallel is missing: `apt-get install parallel`"), std::string::npos)
      << absent.text;
}

}  // namespace
