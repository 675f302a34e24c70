// Buttons, keys and files of the page.
const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4];
export const kWireModes = ["off", "over", "alone"];

const $ = (id) => document.getElementById(id);

export function addControls(player) {
  const changeSpeed = (by) => {
    const { options, selectedIndex } = $("speed");
    $("speed").selectedIndex = Math.min(Math.max(selectedIndex + by, 0), options.length - 1);
    player.setSpeed(Number($("speed").value));
  };
  const actions = {
    play: () => player.setPlaying(!player.playback.playing),
    wire: () => player.setWire((player.wire + 1) % kWireModes.length),
    flat: () => player.setFlat(!player.flat),
    plain: () => player.setPlain(!player.viewer.plain),
    errors: () => player.setPaintsErrors(!player.deviation.isShown),
    up: () => player.setUp(player.up === "y" ? "z" : "y"),
    home: () => player.viewer.lookAtAll(),
    check: () => player.checkAll(),
    open: () => $("file").click(),
    "open-first": () => $("file").click(),
  };
  for (const [id, action] of Object.entries(actions)) $(id).onclick = action;
  $("speed").append(...kSpeeds.map(
    (speed) => new Option(`${speed}×`, speed, speed === 1, speed === 1)));
  $("speed").onchange = () => changeSpeed(0);
  $("clip").onchange = () => player.chooseClip(player.session.decoder.clips[$("clip").value]);
  $("slider").oninput = () => player.seek(Number($("slider").value));
  addKeys(player, actions, changeSpeed);
  addFiles(player);
  onresize = () => player.resize();
}

function addKeys(player, actions, changeSpeed) {
  const keys = {
    " ": actions.play, k: actions.play, w: actions.wire, n: actions.flat, t: actions.plain,
    e: actions.errors, u: actions.up, h: actions.home, c: actions.check, o: actions.open,
    ArrowLeft: () => player.step(-1), ArrowRight: () => player.step(1),
    ArrowDown: () => player.step(-10), ArrowUp: () => player.step(10),
    Home: () => player.seek(player.playback.first),
    End: () => player.seek(player.playback.first + player.playback.count - 1),
    "[": () => changeSpeed(-1), "]": () => changeSpeed(1),
  };
  onkeydown = (event) => {
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    const isReady = player.playback || action === actions.open;
    if (!action || !isReady || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action();
  };
}

/** Opens files that are dropped or chosen. */
function addFiles(player) {
  const open = (file) => file && player.open(file.name, file);
  $("file").onchange = () => {
    open($("file").files[0]);
    $("file").value = ""; // the same file can be chosen again
  };
  ondragover = (event) => event.preventDefault();
  ondrop = (event) => {
    event.preventDefault();
    open(event.dataTransfer.files[0]);
  };
}

/** Shows the list of clips, if any. Clips may have the same name: values are indices. */
export function showClips(clips) {
  $("clip").hidden = clips.length === 0;
  $("clip").replaceChildren(new Option("All clips", ""),
    ...clips.map(({ name }, index) => new Option(name, index)));
}

export function showToggles({ wire, flat, viewer, deviation, isChecking, up }) {
  $("wire").setAttribute("aria-pressed", wire > 0);
  $("flat").setAttribute("aria-pressed", flat);
  $("plain").setAttribute("aria-pressed", !viewer.plain);
  $("errors").setAttribute("aria-pressed", Boolean(deviation?.isShown));
  $("check").setAttribute("aria-pressed", isChecking);
  $("up").textContent = `${up.toUpperCase()} up`;
}
