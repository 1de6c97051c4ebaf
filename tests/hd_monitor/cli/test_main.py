import os
import subprocess
import sys
from pathlib import Path

import pytest

from hd_monitor import __version__
from hd_monitor.cli import extensions
from hd_monitor.cli.main import COMMANDS, SIMULATOR_COMMANDS, main


def test_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["--help"])
    assert caught.value.code == 0
    output = capsys.readouterr().out
    assert all(name in output for name in (*COMMANDS, *SIMULATOR_COMMANDS))


@pytest.mark.parametrize("words", [[], ["--dance"], ["replay", "--dance"]])
def test_wrong_words_are_status_2(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(words)
    assert caught.value.code == 2
    assert "usage: hd-monitor" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("word", "says"),
    [
        ("reply", "'reply' is not one of its commands; did you mean replay?"),
        ("dance", "'dance' is not one of its commands; hd-monitor --help lists them"),
    ],
)
def test_a_misspelt_command_is_one_line(word: str, says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([word, "--report", "x"]) == 2
    assert says in capsys.readouterr().err


def test_the_version_is_that_of_the_package(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["--version"])
    assert caught.value.code == 0
    assert capsys.readouterr().out == f"hd-monitor {__version__}\n"


@pytest.mark.parametrize("name", COMMANDS)
def test_the_help_of_every_command_says_what_it_does_and_how_it_ends(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as caught:
        main([name, "--help"])
    assert caught.value.code == 0
    words = " ".join(capsys.readouterr().out.split())
    assert words.startswith(f"usage: hd-monitor {name} ")
    assert "exit status: 0 done" in words.lower()


@pytest.mark.parametrize(
    ("line", "offers"),
    [
        ("hd-monitor re", {"replay"}),
        ("hd-monitor replay --rep", {"--report"}),
        ("hd-monitor replay --fail-on ", {"error", "warn"}),
    ],
)
def test_the_shell_completes_commands_options_and_choices(tmp_path: Path, line: str, offers: set[str]) -> None:
    pytest.importorskip("argcomplete")
    out = tmp_path / "completions"
    asked = {"COMP_LINE": line, "COMP_POINT": str(len(line)), "_ARGCOMPLETE_STDOUT_FILENAME": str(out)}
    shell = {"_ARGCOMPLETE": "1", "_ARGCOMPLETE_IFS": "\n", "_ARGCOMPLETE_SUPPRESS_SPACE": "1", **asked}
    code = "import sys; from hd_monitor.cli.main import main; sys.exit(main())"
    subprocess.run([sys.executable, "-c", code], env={**os.environ, **shell}, timeout=60, check=False)
    assert {word.strip() for word in out.read_text().split("\n")} == offers


def run_without(package: str, *words: str, module: str = "hd_monitor.cli.main") -> subprocess.CompletedProcess[str]:
    """Run an executable in an interpreter in which `package` cannot be imported."""
    block = f"import sys; sys.modules[{package!r}] = None"
    code = f"{block}; from {module} import main; sys.exit(main(sys.argv[1:]))"
    return subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, timeout=60, check=False)


@pytest.mark.parametrize(
    ("package", "words", "advice"),
    [
        ("rclpy", ("demo",), "source your ROS installation"),
        ("diagnostic_msgs", ("demo", "--defect", "both"), "needs ROS 2 (diagnostic_msgs is missing)"),
        ("hd_sim_node", ("demo",), "needs the package hd_sim_node, which is not installed"),
        ("hd_sim_node", ("parameters",), "needs the package hd_sim_node, which is not installed"),
        ("mcap", ("replay", "bag"), "'.[offline]'"),
        ("pyarrow", ("history", "--history", "missing", "--parquet", "out"), "'.[parquet]'"),
        ("textual", ("watch",), "'.[watch]'"),
    ],
)
def test_what_is_missing_is_one_clear_line(package: str, words: tuple[str, ...], advice: str) -> None:
    done = run_without(package, *words)
    assert done.returncode == 2
    assert advice in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not done.stdout


@pytest.mark.parametrize(
    ("module", "words"),
    [
        ("hd_monitor.cli.main", ("replay", "bag", "--params")),
        ("hd_monitor.cli.main", ("identify", "bag", "--params")),
        ("hd_monitor.ros.__main__", ("--ros-args", "--params-file")),
        ("hd_sim_node.__main__", ("--ros-args", "--params-file")),
    ],
    ids=["replay", "identify", "monitor", "rig"],
)
@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("/**: {ros__parameters: hello}", "ros__parameters of /** is 'hello'"),
        ("5", "holds 5 where parameters belong"),
        ("[1, 2]", "holds [1, 2] where parameters belong"),
        ("/**: &a {ros__parameters: *a}", "an alias repeats itself"),
        ("[" * 5000, "nested too deeply"),
    ],
    ids=["word", "number", "list", "alias", "brackets"],
)
def test_a_file_without_parameters_is_refused_before_numpy_is_imported(
    module: str, words: tuple[str, ...], text: str, cause: str, tmp_path: Path
) -> None:
    (tmp_path / "parameters.yaml").write_text(text)
    done = run_without("numpy", *words, str(tmp_path / "parameters.yaml"), module=module)
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert cause in line


@pytest.mark.parametrize("words", [["demo"], ["demo", "--help"], ["gallery"], ["parameters", "--node", "sim"]])
def test_without_the_simulators_package_its_commands_say_what_to_install(
    words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(extensions, "declared", lambda group: {})
    assert main(words) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line == f"hd-monitor {words[0]}: {extensions.SIMULATOR_MISSING}"


def test_without_the_simulators_package_the_rest_is_there(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(extensions, "declared", lambda group: {})
    assert main(["parameters"]) == 0
    output = capsys.readouterr().out
    assert "## hd_monitor_node" in output
    assert "## hd_sim_node" not in output


def test_any_package_can_add_a_command(tmp_path: Path) -> None:
    (tmp_path / "greeter.py").write_text(
        "def configure(parser): parser.add_argument('name')\n"
        "def run(arguments): print('hello', arguments.name); return 7\n"
    )
    metadata = tmp_path / "greeter-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: greeter\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(f"[{extensions.COMMANDS}]\ngreet = greeter\n")
    paths = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])

    def hd_monitor(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "hd_monitor.cli.main", *words]
        environment = os.environ | {"PYTHONPATH": paths}
        return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=False)

    done = hd_monitor("greet", "you")
    assert (done.returncode, done.stdout) == (7, "hello you\n"), done.stderr
    assert "from the package greeter" in hd_monitor("--help").stdout


def test_a_command_needs_no_other_commands_packages() -> None:
    done = run_without("rclpy", "replay", "--help")
    assert done.returncode == 0, done.stderr


def shell(redirection: str, *command: str) -> tuple[int, str]:
    """Run one of the project's modules with redirections of a shell; return its status and what it says."""
    line = f'exec "$0" -m "$@" {redirection}'
    done = subprocess.run(
        ["sh", "-c", line, sys.executable, *command], capture_output=True, text=True, timeout=60, check=False
    )
    return done.returncode, done.stdout + done.stderr


EXECUTABLES = [
    ("hd_monitor.cli.main", "parameters"),
    ("hd_monitor.cli.main", "--help"),
    ("hd_sim_node.bag_command", "--help"),
]


@pytest.mark.parametrize("command", EXECUTABLES)
@pytest.mark.parametrize(
    ("redirection", "words"),
    [
        (">/dev/full", "standard output cannot be written: No space left on device"),
        (">&-", "standard output is closed; redirect it"),
        ("2>&-", "standard error is closed; redirect it"),
    ],
)
def test_output_that_cannot_be_written_is_one_line_and_status_3(
    monkeypatch: pytest.MonkeyPatch, command: tuple[str, ...], redirection: str, words: str
) -> None:
    monkeypatch.delenv("PYTHONUNBUFFERED", raising=False)  # argparse swallows the error if it comes at once
    status, said = shell(redirection, *command)
    assert status == 3
    assert words in said
    assert said.count("\n") == 1, said


@pytest.mark.parametrize("redirection", [">/dev/full 2>&1", ">&- 2>&-", "2>/dev/full >&-"])
def test_where_nothing_can_be_said_the_status_is_still_3(redirection: str) -> None:
    assert shell(redirection, "hd_monitor.cli.main", "parameters") == (3, "")


@pytest.mark.parametrize("command", EXECUTABLES)
def test_a_terminal_without_the_symbols_is_one_line_and_status_3(
    monkeypatch: pytest.MonkeyPatch, command: tuple[str, ...]
) -> None:
    monkeypatch.setenv("PYTHONIOENCODING", "ascii")
    status, said = shell("", *command)
    assert status == 3
    assert "standard output is encoded in ascii, which lacks '\\u03b6'; set PYTHONIOENCODING=utf-8" in said
    assert said.count("\n") == 1, said


@pytest.mark.parametrize("module", ["hd_monitor.ros", "hd_sim_node"])
def test_the_nodes_refuse_a_closed_stream_alike(module: str) -> None:
    status, said = shell(">&-", module)
    assert status == 3
    assert "standard output is closed" in said


def test_an_error_of_our_own_ends_with_status_3(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("hd_monitor.cli.parameters.node_tables", lambda: {"key": 0}["no such key"])
    assert main(["parameters"]) == 3
    lines = capsys.readouterr().err.splitlines()
    assert lines[0].startswith("Traceback")
    assert lines[-1] == (
        "hd-monitor parameters: internal error (KeyError: 'no such key'); please report it with the lines above"
    )


def test_a_reader_that_leaves_causes_no_traceback() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    for output, error in ((writing, subprocess.PIPE), (writing, writing)):
        command = [sys.executable, "-m", "hd_monitor.cli.main", "parameters"]
        done = subprocess.run(command, stdout=output, stderr=error, timeout=60, check=False)
        assert (done.returncode, done.stderr or b"") == (141, b"")
    os.close(writing)
