"""A ROS 2 node that calls services and actions, run by the interpreter of ros2_env: reads a JSON list of calls from stdin, prints the
list of their responses.

    {"service": "/step_simulation", "type": "simulation_interfaces/srv/StepSimulation", "request": {"steps": 3}}
    {"action": "/simulate_steps", "type": "simulation_interfaces/action/SimulateSteps", "goal": {"steps": 3}, "cancel_after": 0.5}
    {"sleep": 0.5}
"""
import array
import importlib
import json
import sys
import time

import numpy
import rclpy
from rclpy.action import ActionClient

LONGEST = 60  # [s] of one call


def load(name):
    package, kind, short = name.split("/")
    return getattr(importlib.import_module(f"{package}.{kind}"), short)


def fill(message, values):
    """Sets fields of a message; lists of messages are made by the type of their elements."""
    types = message.get_fields_and_field_types()
    for name, value in values.items():
        current = getattr(message, name)
        if isinstance(value, dict):
            fill(current, value)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            element = types[name].removeprefix("sequence<").split(",")[0].rstrip(">").split("[")[0]
            package, short = element.split("/")
            setattr(message, name, [fill(load(f"{package}/msg/{short}")(), item) for item in value])
        else:
            setattr(message, name, value)
    return message


def plain(value):
    if hasattr(value, "get_fields_and_field_types"):
        return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if isinstance(value, (list, tuple, array.array, numpy.ndarray)):
        return [plain(item) for item in value]
    if isinstance(value, bytes):
        return list(value)
    return value.item() if isinstance(value, numpy.generic) else value


def wait(node, future, seconds=LONGEST):
    rclpy.spin_until_future_complete(node, future, timeout_sec=seconds)
    if not future.done():
        raise TimeoutError("no answer")
    return future.result()


def call_service(node, clients, call):
    kind = load(call["type"])
    client = clients.setdefault(call["service"], node.create_client(kind, call["service"]))
    if not client.wait_for_service(timeout_sec=LONGEST):
        raise TimeoutError(f"no service {call['service']}")
    return plain(wait(node, client.call_async(fill(kind.Request(), call.get("request", {})))))


def run_action(node, call):
    kind = load(call["type"])
    client = ActionClient(node, kind, call["action"])
    if not client.wait_for_server(timeout_sec=LONGEST):
        raise TimeoutError(f"no action {call['action']}")
    feedback = []
    handle = wait(node, client.send_goal_async(fill(kind.Goal(), call.get("goal", {})), lambda m: feedback.append(plain(m.feedback))))
    answer = {"accepted": handle.accepted}
    if handle.accepted:
        result = handle.get_result_async()
        if "cancel_after" in call:
            end = time.monotonic() + call["cancel_after"]
            while time.monotonic() < end:
                rclpy.spin_once(node, timeout_sec=0.02)
            answer["cancelling"] = len(wait(node, handle.cancel_goal_async()).goals_canceling)
        done = wait(node, result)
        answer |= {"status": done.status, "result": plain(done.result), "feedback": feedback}
    client.destroy()
    return answer


def main():
    rclpy.init()
    node = rclpy.create_node("caller")
    clients, answers = {}, []
    for call in json.load(sys.stdin):
        if "sleep" in call:
            time.sleep(call["sleep"])
            answers.append(None)
        elif "action" in call:
            answers.append(run_action(node, call))
        else:
            answers.append(call_service(node, clients, call))
    print(json.dumps(answers))
    sys.stdout.flush()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
