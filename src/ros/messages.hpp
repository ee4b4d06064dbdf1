/// This package's messages, in namespace bin_scenes_msgs.
///
/// The generator puts them into a namespace named after the package, where bin_scenes::Scene, bin_scenes::Sensor and
/// others would collide with the library's structs of the same names. Inside this package the generated headers are
/// therefore read under another namespace. A file of another package that uses library and messages includes this
/// header, installed as bin_scenes/messages.hpp. Type names and MD5 sums are string literals and do not change; files
/// that use the messages alone include the generated headers as usual.
#pragma once

// Everything that the generated headers include comes first, so that the renaming touches nothing else.
#include <actionlib_msgs/GoalID.h>
#include <actionlib_msgs/GoalStatus.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/Vector3.h>
#include <ros/builtin_message_traits.h>
#include <ros/message_operations.h>
#include <ros/serialization.h>
#include <ros/service_traits.h>
#include <ros/types.h>
#include <std_msgs/Header.h>

#include <memory>
#include <string>
#include <vector>

#define bin_scenes bin_scenes_msgs
#include <bin_scenes/AddParts.h>
#include <bin_scenes/ErrorCode.h>
#include <bin_scenes/GenerateScene.h>
#include <bin_scenes/GenerateSceneAction.h>
#include <bin_scenes/GetGrasps.h>
#include <bin_scenes/PickPart.h>
#include <bin_scenes/Scene.h>
#include <bin_scenes/SceneRequest.h>
#undef bin_scenes
