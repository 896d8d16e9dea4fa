"""Definitions of messages, services and actions that the wheels of rclpy lack, for tests to talk to Gloam with: written down from
the packages' interface documentation (tf2_msgs, control_msgs, simulation_interfaces 2.1 and, as SIMULATION_1, what differs in 1.x)."""

TF2 = {"msg/TFMessage": "geometry_msgs/TransformStamped[] transforms"}

CONTROL = {
    "msg/JointTolerance": "string name\nfloat64 position\nfloat64 velocity\nfloat64 acceleration",
    "msg/JointComponentTolerance": """uint16 X_AXIS=1
uint16 Y_AXIS=2
uint16 Z_AXIS=3
uint16 TRANSLATION=4
uint16 ROTATION=5
string joint_name
uint16 component
float64 position
float64 velocity
float64 acceleration""",
    "action/FollowJointTrajectory": """trajectory_msgs/JointTrajectory trajectory
trajectory_msgs/MultiDOFJointTrajectory multi_dof_trajectory
JointTolerance[] path_tolerance
JointComponentTolerance[] component_path_tolerance
JointTolerance[] goal_tolerance
JointComponentTolerance[] component_goal_tolerance
builtin_interfaces/Duration goal_time_tolerance
---
int32 error_code
int32 SUCCESSFUL = 0
int32 INVALID_GOAL = -1
int32 INVALID_JOINTS = -2
int32 OLD_HEADER_TIMESTAMP = -3
int32 PATH_TOLERANCE_VIOLATED = -4
int32 GOAL_TOLERANCE_VIOLATED = -5
string error_string
---
std_msgs/Header header
string[] joint_names
trajectory_msgs/JointTrajectoryPoint desired
trajectory_msgs/JointTrajectoryPoint actual
trajectory_msgs/JointTrajectoryPoint error
string[] multi_dof_joint_names
trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_desired
trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_actual
trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_error""",
}

RESULT = "Result result"
SIMULATION = {
    "msg/Result": "uint8 result\nstring error_message",
    "msg/Resource": "string uri\nstring resource_string",
    "msg/SimulationState": "uint8 state",
    "msg/EntityState": "std_msgs/Header header\ngeometry_msgs/Pose pose\ngeometry_msgs/Twist twist\ngeometry_msgs/Accel acceleration",
    "msg/EntityCategory": "uint8 category",
    "msg/EntityInfo": "EntityCategory category\nstring description\nstring[] tags",
    "msg/TagsFilter": "string[] tags\nuint8 filter_mode",
    "msg/Bounds": "uint8 type\ngeometry_msgs/Vector3[] points",
    "msg/EntityFilters": "string filter\nEntityCategory[] categories\nTagsFilter tags\nBounds bounds",
    "msg/NamedPose": "string name\nstring description\nstring[] tags\ngeometry_msgs/Pose pose",
    "msg/Spawnable": "Resource entity_resource\nstring description\nBounds spawn_bounds",
    "msg/SpawnEntity": "string name\nbool allow_renaming\nResource entity_resource\nstring entity_namespace\n"
                       "geometry_msgs/PoseStamped initial_pose",
    "msg/SpawnResult": "Result result\nstring entity_name",
    "msg/WorldResource": "string name\nResource world_resource\nstring description\nstring[] tags",
    "msg/SimulatorFeatures": "uint16[] features\nstring[] spawn_formats\nstring custom_info",
    "srv/GetSimulatorFeatures": "---\nSimulatorFeatures features",
    "srv/GetSimulationState": "---\nSimulationState state\nResult result",
    "srv/SetSimulationState": f"SimulationState state\n---\n{RESULT}",
    "srv/StepSimulation": f"uint64 steps 1\n---\n{RESULT}",
    "srv/ResetSimulation": f"uint8 scope\n---\n{RESULT}",
    "srv/SpawnEntity": "string name\nbool allow_renaming\nResource entity_resource\nstring entity_namespace\n"
                       "geometry_msgs/PoseStamped initial_pose\n---\nResult result\nstring entity_name",
    "srv/SpawnEntities": "SpawnEntity[] spawn_requests\n---\nResult result\nSpawnResult[] results",
    "srv/DeleteEntity": f"string entity\n---\n{RESULT}",
    "srv/GetEntities": "EntityFilters filters\n---\nResult result\nstring[] entities",
    "srv/GetEntitiesStates": "EntityFilters filters\n---\nResult result\nstring[] entities\nEntityState[] states",
    "srv/GetEntityState": "string entity\n---\nResult result\nEntityState state",
    "srv/SetEntityState": f"string entity\nEntityState state\nbool set_pose\nbool set_twist\nbool set_acceleration\n---\n{RESULT}",
    "srv/GetEntityInfo": "string entity\n---\nResult result\nEntityInfo info",
    "srv/SetEntityInfo": f"string entity\nEntityInfo info\n---\n{RESULT}",
    "srv/GetEntityBounds": "string entity\n---\nResult result\nBounds bounds",
    "srv/GetNamedPoses": "TagsFilter tags\n---\nResult result\nNamedPose[] poses",
    "srv/GetNamedPoseBounds": "string name\n---\nResult result\nBounds bounds",
    "srv/GetSpawnables": "string[] sources\n---\nResult result\nSpawnable[] spawnables",
    "srv/LoadWorld": "Resource world_resource\nbool fail_on_unsupported_element\nbool ignore_missing_or_unsupported_assets\n---\n"
                     "Result result\nWorldResource world",
    "srv/UnloadWorld": f"---\n{RESULT}",
    "srv/GetCurrentWorld": "---\nResult result\nWorldResource world",
    "srv/GetAvailableWorlds": "string[] additional_sources\nTagsFilter filter\nbool offline_only\nbool continue_on_error\n---\n"
                              "Result result\nWorldResource[] worlds",
    "action/SimulateSteps": f"uint64 steps\n---\n{RESULT}\n---\nuint64 completed_steps\nuint64 remaining_steps",
}

# Package: its interfaces and what they are made of.
PACKAGES = {
    "tf2_msgs": (TF2, ["geometry_msgs"]),
    "control_msgs": (CONTROL, ["std_msgs", "builtin_interfaces", "trajectory_msgs"]),
    "simulation_interfaces": (SIMULATION, ["std_msgs", "geometry_msgs"]),
}
