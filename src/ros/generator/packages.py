"""Packages of interface definitions: which message a field refers to, and an order in which C++ can declare them.

The folder PACKAGE/{msg,srv,action}/ holds the current version of a package. PACKAGE-VERSION/ holds the interfaces that differ
in an older version; all other types are taken from the current one.
"""

import re
from dataclasses import dataclass, field

from definitions import PACKAGE_NAME, PARTS, PRIMITIVES, DefinitionError, Field, Message, Type, read_definition

KINDS = list(PARTS)


@dataclass
class Package:
    ros_name: str  # "control_msgs"
    namespace: str  # "control_msgs", "control_msgs_5" of an older version
    path: object
    messages: dict = field(default_factory=dict)  # by kind and name: ("srv", "SetBool_Request")

    @property
    def is_current(self):
        return self.namespace == self.ros_name


@dataclass(frozen=True)
class Reference:
    """A message that a field refers to."""

    namespace: str
    kind: str
    name: str


def read_packages(folder):
    """{namespace: Package} of all definitions in a folder, with every field's `target`: a Reference, or None of primitives."""
    packages = {}
    for path in sorted(folder.iterdir()):
        if path.name.startswith("."):
            continue
        package = read_package(path)
        if package.namespace in packages:
            raise DefinitionError(path, 0, f"another folder already defines namespace {package.namespace}")
        packages[package.namespace] = package
    for package in packages.values():
        for message in package.messages.values():
            for part in message.fields:
                part.target = find_message(packages, package, message, part)
    return packages


def read_package(path):
    name, _, version = path.name.partition("-")
    if not path.is_dir() or not PACKAGE_NAME.fullmatch(name) or not re.fullmatch(r"[0-9]*", version):
        raise DefinitionError(path, 0, "expected a folder PACKAGE or PACKAGE-VERSION")
    package = Package(name, f"{name}_{version}" if version else name, path)
    for file in sorted(path.rglob("*")):
        if file.is_dir() or file.name.startswith("."):
            continue
        kind = file.suffix[1:]
        if kind not in KINDS or file.parent != path / kind:
            raise DefinitionError(file, 0, "expected PACKAGE/msg/Name.msg, PACKAGE/srv/Name.srv or PACKAGE/action/Name.action")
        messages = read_definition(file)
        if kind == "action":
            messages += action_messages(package, *messages)
        package.messages |= {(kind, message.name): message for message in messages}
    return package


def action_messages(package, goal, result, feedback):
    """The five messages that ROS derives from an action: of its two services and of its topic of feedback."""
    base = goal.name.removesuffix("_Goal")

    def derived(suffix, *fields):
        return Message(base + suffix, goal.path, [Field(Type(element), name, 1) for element, name in fields])

    def own(message):
        return Reference(package.namespace, "action", message.name)

    goal_id = ("unique_identifier_msgs/UUID", "goal_id")
    return [derived("_SendGoal_Request", goal_id, (own(goal), "goal")),
            derived("_SendGoal_Response", ("bool", "accepted"), ("builtin_interfaces/Time", "stamp")),
            derived("_GetResult_Request", goal_id),
            derived("_GetResult_Response", ("int8", "status"), (own(result), "result")),
            derived("_FeedbackMessage", goal_id, (own(feedback), "feedback"))]


def find_message(packages, package, message, part):
    element = part.type.element
    if isinstance(element, Reference):
        return element
    if element in PRIMITIVES:
        return None
    *of, name = element.split("/")
    ros_name = of[0] if of else package.ros_name
    for namespace in (package.namespace, ros_name) if ros_name == package.ros_name else (ros_name,):
        if namespace in packages and ("msg", name) in packages[namespace].messages:
            return Reference(namespace, "msg", name)
    raise DefinitionError(message.path, part.line, f"field '{part.name}': there is no message {ros_name}/{name}")


def in_order(nodes, edges, describe):
    """`nodes`, sorted so that each follows the nodes that it needs. edges(node): [(node, path, line)], where it needs them."""
    done, open_nodes, order = set(), [], []

    def visit(node):
        open_nodes.append(node)
        for needed, path, line in edges(node):
            if needed in open_nodes:
                cycle = open_nodes[open_nodes.index(needed):] + [needed]
                raise DefinitionError(path, line, "the definitions form a cycle: " + " -> ".join(map(describe, cycle)))
            if needed not in done:
                visit(needed)
        done.add(open_nodes.pop())
        order.append(node)

    for node in nodes:
        if node not in done:
            visit(node)
    return order


def declaration_order(package):
    """Keys of the package's messages, sorted so that each follows the messages of its package that it contains."""

    def edges(key):
        message = package.messages[key]
        return [((part.target.kind, part.target.name), message.path, part.line) for part in message.fields
                if part.target and part.target.namespace == package.namespace]

    keys = sorted(package.messages, key=lambda key: KINDS.index(key[0]))
    return in_order(keys, edges, lambda key: f"{package.ros_name}/{key[1]}")


def needed_packages(package):
    """{namespace: (path, line)} of the other packages whose messages this one contains, with the first field that does."""
    needed = {}
    for message in package.messages.values():
        for part in message.fields:
            if part.target and part.target.namespace != package.namespace:
                needed.setdefault(part.target.namespace, (message.path, part.line))
    return needed


def package_order(packages):
    """Namespaces, sorted so that each follows the namespaces that it needs."""
    return in_order(sorted(packages), lambda name: [(other, *place) for other, place in sorted(needed_packages(packages[name]).items())],
                    str)
