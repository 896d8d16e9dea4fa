import { kLeftPanels, kRightPanels } from "./panels/list";
import { left_open, left_width, right_open, right_width } from "./settings";
import { hello, link_problem, link_state, state } from "./state";
import { HelpDialog } from "./help";
import { StatusBar } from "./status";
import { Timeline } from "./timeline";
import { TopBar } from "./topbar";
import { Stage } from "./view/stage";
import { SidePanel } from "./widgets/side_panel";

export function App() {
  document.title = hello.value?.title ? `${hello.value.title} – Gloam` : "Gloam";
  return (
    <>
      <TopBar />
      <Banner />
      <div class="middle">
        <SidePanel side="left" open={left_open} width={left_width} panels={kLeftPanels} />
        <Stage />
        <SidePanel side="right" open={right_open} width={right_width} panels={kRightPanels} />
      </div>
      <Timeline />
      <StatusBar />
      <HelpDialog />
    </>
  );
}

/** The reason why nothing moves: a lost connection, or an error of the simulation. */
function Banner() {
  const text = link_state.value === "lost" || link_state.value === "ended" ? link_problem.value : state.value?.error ?? "";
  return text ? <div class="banner" id="banner" role="alert">{text}</div> : null;
}
