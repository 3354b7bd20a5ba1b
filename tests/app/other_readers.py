"""Whether other programs read the images of `odis`: OpenEXR for Python, oiiotool or exrheader.

    other_readers.py OpenEXR|oiiotool|exrheader ODIS

Exit code 77: the program is not installed."""
import itertools
import pathlib
import shutil
import subprocess
import sys
import tempfile

SCENE = """<scene version="3.0.0">
  <sensor type="perspective">
    <film type="hdrfilm"><integer name="width" value="12"/><integer name="height" value="8"/></film>
  </sensor>
  <shape type="sphere"><point name="center" x="0" y="0" z="4"/></shape>
  <emitter type="constant"/>
</scene>"""
NO_DENOISER, SKIPPED = 5, 77


def skip(what):
    print(f"skipped: {what} is not installed; scripts/setup --dev installs it")
    sys.exit(SKIPPED)


def output(*command):
    """What a command prints; it must end with 0, and not complain."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode != 0 or "error" in done.stderr.lower():
        sys.exit(f"{command}: ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


def channels_by_openexr(path):
    # Channels that belong together come as one array, which a file of several types has none of.
    with OpenEXR.File(str(path)) as file:
        together = set(file.channels())
    with OpenEXR.File(str(path), separate_channels=True) as file:
        for name, channel in file.channels().items():
            if channel.pixels.shape != (8, 12):
                sys.exit(f"{path}: {name}: found {channel.pixels.shape}, expected 8 x 12 pixels")
        return set(file.channels()), together


def channels_by_oiiotool(path):
    lines = output("oiiotool", "--info", "-v", "--stats", path).splitlines()
    line = next(line for line in lines if "channel list:" in line)
    return {word.split(" ")[0] for word in line.split(": ")[1].split(", ")}, None


def channels_by_exrheader(path):
    lines = output("exrheader", path).splitlines()
    start = lines.index("channels (type chlist):") + 1
    end = next(i for i in range(start, len(lines)) if not lines[i].startswith(" "))
    return {line.split(",")[0].strip() for line in lines[start:end]}, None


def check(path, channels_of, expected):
    found, together = channels_of(path)
    if missing := expected - found:
        sys.exit(f"{path}: found the channels {sorted(found)}, expected {sorted(missing)} as well")
    colors = "RGBA" if "A" in expected else "RGB"
    if together is not None and colors not in together:
        sys.exit(f"{path}: found {sorted(together)}, expected {colors} as one")


def check_all(odis, channels_of, folder):
    scene = folder / "room.xml"
    scene.write_text(SCENE)
    layers = {"": "", "alpha": "A", "albedo,normal": "albedo.R N.X", "depth,roughness,position": "depth.Z roughness.Y P.X",
              "guide": "guide.alpha guide.cell", "all": "A albedo.G N.Y P.Z depth.Z roughness.Y guide.samples"}
    images, denoises = [], True
    for (aov, names), variance, denoise in itertools.product(layers.items(), (False, True), (False, True)):
        if denoise and not denoises:
            continue
        path = folder / f"{len(images)}.exr"
        options = ["--aov", aov] * (aov != "") + ["--variance"] * variance + ["--denoise"] * denoise
        command = [odis, "render", scene, "-q", "--spp", "4", "-o", path, *options]
        done = subprocess.run([str(word) for word in command], check=False)
        if denoise and done.returncode == NO_DENOISER:
            denoises = False
            continue
        if done.returncode != 0:
            sys.exit(f"{command}: ended with {done.returncode}")
        expected = {"R", "G", "B", *names.split()} | ({"variance.B"} if variance else set())
        images.append((path, expected | ({"noisy.R", "albedo.B"} if denoise else set())))
    made = folder / "made.exr"
    last, expected = images[-1]
    output(odis, "image", "average", last, last, "-o", made)
    images.append((made, expected))
    merged = folder / "merged.exr"
    output(odis, "image", "merge", last, f"other={made}", "-o", merged)
    images.append((merged, expected | {"other.A"}))
    if denoises:
        later = folder / "later.exr"
        output(odis, "denoise", last, "-q", "-o", later)
        images.append((later, expected | {"noisy.B"}))
    for path, expected in images:
        check(path, channels_of, expected)
    print(f"{len(images)} images are read" + ("" if denoises else ", none of them denoised: there is no denoiser"))


reader, program = sys.argv[1:]
if reader == "OpenEXR":
    try:
        import OpenEXR
    except ImportError:
        skip("OpenEXR for Python")
elif not shutil.which(reader):
    skip(reader)
with tempfile.TemporaryDirectory() as scratch:
    check_all(program, {"OpenEXR": channels_by_openexr, "oiiotool": channels_by_oiiotool,
                        "exrheader": channels_by_exrheader}[reader], pathlib.Path(scratch))
