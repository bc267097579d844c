// The page in a browser: no horizontal scrolling and no text over text, on a desk and on a telephone.
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "apps/diagnose/report.hpp"
#include "tests/apps/diagnose_result.hpp"
#include "tests/support/program.hpp"

namespace {

// Runs in the page: how wide it is, and which pieces of text lie over each other by more than two pixels.
constexpr const char* check_script = R"JS(<script>
addEventListener('load', () => {
  const boxes = [], walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const node = walker.currentNode;
    if (!node.textContent.trim() || node.parentElement.closest('script,style,title')) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const box of range.getClientRects()) if (box.width > 0) boxes.push({box, text: node.textContent, node});
  }
  const over = [];
  for (let i = 0; i < boxes.length; ++i) for (let k = i + 1; k < boxes.length; ++k) {
    const a = boxes[i], b = boxes[k];
    if (a.node === b.node) continue;
    const w = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
    const h = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
    if (w > 2 && h > 4) over.push(a.text.trim().slice(0, 30) + ' | ' + b.text.trim().slice(0, 30));
  }
  const out = boxes.filter(one => one.box.right > innerWidth + 1 || one.box.left < -1).map(one => one.text.trim().slice(0, 30));
  document.body.textContent = 'CHECK width=' + innerWidth + ' scroll=' + document.documentElement.scrollWidth +
    ' texts=' + boxes.length + ' over=' + over.length + ' out=' + out.length + ' ' + over.concat(out).slice(0, 5).join('; ') + ' END';
});
</script></body>)JS";

bool chromium_exists() {
  const bool found = std::system("command -v chromium >/dev/null 2>&1") == 0;
  if (!found) std::puts("skipped: the look of the report, chromium is missing (package chromium)");
  return found;
}

int number_after(const std::string& text, const std::string& key) {
  const std::size_t at = text.find(key);
  return at == std::string::npos ? -1 : std::atoi(text.c_str() + at + key.size());
}

// A headless browser makes no window below 500 pixels, so the page is put into a frame of that width.
std::string looked_at(const approach_program::ScratchFolder& folder, const std::string& html, int width) {
  std::string page = html;
  page.replace(page.rfind("</body>"), std::string("</body>").size(), check_script);
  std::ofstream(folder.file("page.html")) << page;
  std::ofstream(folder.file("frame.html"))
      << "<body style=\"margin:0\"><iframe id=\"f\" src=\"page.html\" style=\"border:0;width:" << width
      << "px;height:6000px\"></iframe><script>addEventListener('load',()=>{"
         "document.title=document.getElementById('f').contentDocument.body.textContent})</script></body>";
  return approach_program::run_command(
             "chromium --headless --no-sandbox --disable-gpu --allow-file-access-from-files "
             "--virtual-time-budget=5000 --window-size=1400,6000 --dump-dom file://" +
             folder.file("frame.html") + " 2>/dev/null")
      .output;
}

}  // namespace

TEST_CASE("the report is readable on a desk and on a telephone" * doctest::skip(!chromium_exists())) {
  const auto report = diagnose_program::make_report(diagnose_test::some_diagnosis(), diagnose_test::some_simulator());
  const approach_program::ScratchFolder folder;
  for (const int width : {1280, 768, 390}) {
    const std::string seen = looked_at(folder, report.html, width);
    const std::string found = seen.substr(seen.find("CHECK") == std::string::npos ? 0 : seen.find("CHECK"), 600);
    CAPTURE(width);
    CAPTURE(found);
    CHECK(number_after(seen, "CHECK width=") == width);
    CHECK(number_after(seen, " scroll=") <= width);
    CHECK(number_after(seen, " texts=") > 100);
    CHECK(number_after(seen, " over=") == 0);
    CHECK(number_after(seen, " out=") == 0);
  }
}
