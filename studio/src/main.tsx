import { render } from "preact";
import { App } from "./app";
import { start_driving } from "./drive";
import { listen_to_keys } from "./keys";
import { connect } from "./link";
import "./style.css";

// The address holds the token, which the cookie has replaced.
history.replaceState(null, "", "/");
render(<App />, document.getElementById("app")!);
listen_to_keys();
start_driving();
connect();
