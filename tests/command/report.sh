#!/usr/bin/env bash
# The page of `glint cost --report` in a browser: it draws without an error on the console, a focused or hovered point
# shows its setting, a heading sorts the table, and it fits the width of a phone. Exits with 77 without a browser.
. tests/command/prelude.sh
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || {
    echo "skip: Chromium is not installed; get it with:  apt-get install chromium"
    exit 77
}
script=$PWD/scripts/workshop.lua
cd "$work" || exit 1

# browse WIDTH URL: writes the document after its scripts have run to dom, and the console to log
browse() {
    HOME=$work timeout 60 "$browser" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --window-size="$1,900" \
        --virtual-time-budget=3000 --enable-logging=stderr --dump-dom "$2" >dom 2>log </dev/null
}

"$GLINT" cost "$script" --size 160x90 --quick --report page --quiet >table || exit 1

# Simulates a reader's actions, and notes the results at the end of the document.
cat >act.html <<'HTML'
<script>
window.addEventListener("load", () => {
  const notes = [], note = (name, text) => notes.push(name + "=" + text);
  const points = Array.from(document.querySelectorAll(".point"));
  const setting = document.getElementById("setting");
  const rows = () => Array.from(document.querySelectorAll("tbody tr"));
  const numbers = column => rows().map(row => row.cells[column].dataset.v).filter(v => v !== "").map(Number);
  const rising = list => list.every((v, i) => i === 0 || list[i - 1] <= v);
  note("points", points.length);
  note("reachable", points.every(point => point.tabIndex === 0));
  points[0].focus();
  note("focus", setting.textContent === document.getElementById("row-" + points[0].dataset.row).dataset.text);
  note("marked", document.querySelectorAll("tr.lit").length);
  points[1].dispatchEvent(new PointerEvent("pointerenter"));
  note("pointer", setting.textContent === document.getElementById("row-" + points[1].dataset.row).dataset.text);
  note("text", setting.textContent);
  const headings = document.querySelectorAll("th button");
  headings[4].click();
  note("up", rising(numbers(4)) && numbers(4).length > 5);
  note("state", headings[4].parentElement.getAttribute("aria-sort"));
  headings[4].click();
  note("down", rising(numbers(4).reverse()));
  headings[0].click();
  note("back", rising(numbers(0)));
  note("pictures", Array.from(document.images).every(image => image.complete || image.loading === "lazy") && document.images.length);
  note("overflow", document.documentElement.scrollWidth - document.documentElement.clientWidth);
  note("own", document.querySelectorAll(".point.own").length);
  const out = document.createElement("pre");
  out.textContent = "NOTES\n" + notes.join("\n") + "\nEND";
  document.body.append(out);
});
</script>
HTML
cat page/index.html act.html >page/acted.html
for width in 360 1200; do
    browse $width "file://$work/page/acted.html"
    sed -n '/NOTES/,/END/p' dom >notes
    check "$width wide: the page ran" grep -q '^END' notes
    check "$width wide: the console is silent: $(grep -E 'CONSOLE' log | head -n 2)" bash -c '! grep -q CONSOLE log'
    for line in reachable=true focus=true marked=1 pointer=true up=true state=ascending down=true back=true overflow=0 own=1; do
        check "$width wide: $line: $(grep "^${line%%=*}=" notes)" grep -qx "$line" notes
    done
    check "$width wide: many points: $(grep points= notes)" grep -qE '^points=([7-9]|[1-9][0-9])$' notes
    check "$width wide: a setting's text: $(grep text= notes)" grep -qE '^text=.*[0-9] ms .*times the script.s; RMSE' notes
    check "$width wide: pictures: $(grep pictures= notes)" grep -qE '^pictures=[1-9]' notes
done
echo '<script>nothing()</script>' | cat page/index.html - >page/broken.html
browse 800 "file://$work/page/broken.html"
check "an error does show on the console" grep -q 'CONSOLE.*nothing is not defined' log
browse 800 "file://$work/page/plot.svg"
check "the plot alone is well-formed" bash -c 'grep -q "<svg" dom && ! grep -q "contains the following errors" dom'

totals
