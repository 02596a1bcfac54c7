/* gpu_pipelines FILE.spv...: compiles compute programs by the first Vulkan driver that there is and
 * prints what it says of each: its name, then statistics as NAME=VALUE. Nothing runs, so a driver
 * without its device does. Bindings are storage from 64 on, images from 128, samplers from 192,
 * uniform blocks below. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

enum { BINDINGS = 256, MOST = 64 };

static void need(VkResult result, const char *what) {
  if (result == VK_SUCCESS) return;
  fprintf(stderr, "gpu_pipelines: %s: Vulkan's error %d\n", what, (int)result);
  exit(1);
}

static VkPhysicalDevice find_device(void) {
  const VkApplicationInfo about = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                   .apiVersion = VK_API_VERSION_1_1};
  const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                     .pApplicationInfo = &about};
  VkInstance instance;
  VkPhysicalDevice device;
  uint32_t count = 1;
  need(vkCreateInstance(&info, NULL, &instance), "an instance");
  vkEnumeratePhysicalDevices(instance, &count, &device);
  if (count == 0) need(VK_ERROR_INITIALIZATION_FAILED, "no device");
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(device, &properties);
  printf("device: %s\n", properties.deviceName);
  return device;
}

static VkDevice make_device(VkPhysicalDevice physical) {
  static const char *const extension[] = {VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME};
  const float priority = 1;
  VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR told = {
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
      .pipelineExecutableInfo = VK_TRUE};
  VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                         .queueCount = 1,
                                         .pQueuePriorities = &priority};
  vkGetPhysicalDeviceFeatures2(physical, &features);
  features.pNext = &told;
  const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                   .pNext = &features,
                                   .queueCreateInfoCount = 1,
                                   .pQueueCreateInfos = &queue,
                                   .enabledExtensionCount = 1,
                                   .ppEnabledExtensionNames = extension};
  VkDevice device;
  need(vkCreateDevice(physical, &info, NULL, &device), "a device");
  return device;
}

static VkPipelineLayout make_layout(VkDevice device) {
  static const VkDescriptorType types[] = {
      VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
      VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
  VkDescriptorSetLayoutBinding binding[BINDINGS];
  for (uint32_t i = 0; i < BINDINGS; i++)
    binding[i] = (VkDescriptorSetLayoutBinding){.binding = i,
                                                .descriptorType = types[i / (BINDINGS / 4)],
                                                .descriptorCount = 1,
                                                .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
  const VkDescriptorSetLayoutCreateInfo set = {
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .bindingCount = BINDINGS,
      .pBindings = binding};
  VkDescriptorSetLayout sets;
  VkPipelineLayout layout;
  need(vkCreateDescriptorSetLayout(device, &set, NULL, &sets), "bindings");
  const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                           .setLayoutCount = 1,
                                           .pSetLayouts = &sets};
  need(vkCreatePipelineLayout(device, &info, NULL, &layout), "a layout");
  return layout;
}

static VkShaderModule load(VkDevice device, const char *path) {
  static uint32_t words[1 << 20];
  FILE *file = fopen(path, "rb");
  const size_t size = file != NULL ? 4 * fread(words, 4, sizeof words / 4, file) : 0;
  if (size == 0) need(VK_ERROR_INITIALIZATION_FAILED, path);
  fclose(file);
  const VkShaderModuleCreateInfo info = {
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = words};
  VkShaderModule module;
  need(vkCreateShaderModule(device, &info, NULL, &module), path);
  return module;
}

static void print_statistics(VkDevice device, VkPipeline pipeline) {
  const PFN_vkGetPipelineExecutableStatisticsKHR get =
      (PFN_vkGetPipelineExecutableStatisticsKHR)vkGetDeviceProcAddr(
          device, "vkGetPipelineExecutableStatisticsKHR");
  const VkPipelineExecutableInfoKHR which = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, .pipeline = pipeline};
  VkPipelineExecutableStatisticKHR s[MOST];
  uint32_t count = MOST;
  for (int i = 0; i < MOST; i++)
    s[i] = (VkPipelineExecutableStatisticKHR){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR};
  need(get(device, &which, &count, s), "statistics");
  for (uint32_t i = 0; i < count; i++)
    if (s[i].format == VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR)
      printf("\t%s=%llu", s[i].name, (unsigned long long)s[i].value.u64);
}

int main(int argc, char **argv) {
  const VkDevice device = make_device(find_device());
  const VkPipelineLayout layout = make_layout(device);
  for (int i = 1; i < argc; i++) {
    const VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = load(device, argv[i]),
                  .pName = "main"},
        .layout = layout};
    VkPipeline pipeline;
    need(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline), argv[i]);
    printf("%s", argv[i]);
    print_statistics(device, pipeline);
    printf("\n");
    vkDestroyPipeline(device, pipeline, NULL);
    vkDestroyShaderModule(device, info.stage.module, NULL);
  }
  return 0;
}
