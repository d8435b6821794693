// SPDX-License-Identifier: GPL-2.0 OR Apache-2.0
// A PWM chip of four channels without hardware (Linux 6.1). What its pins do stands in
// /sys/devices/platform/pwm-sim/outputs, a line for each channel: "PERIOD_NS DUTY_NS INVERSED ENABLED". An errno
// written to `error` beside it is what the chip answers from then on; 0 mends it.
#include <linux/module.h>
#include <linux/platform_device.h>
#include <linux/pwm.h>

#define CHANNELS 4

static struct pwm_state outputs[CHANNELS];
static int error;
static struct pwm_chip chip;
static struct platform_device *device;

static int pwm_sim_apply(struct pwm_chip *owner, struct pwm_device *pwm, const struct pwm_state *state)
{
	if (error)
		return -error;
	outputs[pwm->hwpwm] = *state;
	return 0;
}

static const struct pwm_ops pwm_sim_ops = {
	.apply = pwm_sim_apply,
	.owner = THIS_MODULE,
};

static ssize_t outputs_show(struct device *dev, struct device_attribute *attribute, char *text)
{
	ssize_t length = 0;
	int i;

	for (i = 0; i < CHANNELS; i++)
		length += sysfs_emit_at(text, length, "%llu %llu %d %d\n", outputs[i].period,
					outputs[i].duty_cycle,
					outputs[i].polarity == PWM_POLARITY_INVERSED,
					outputs[i].enabled);
	return length;
}
static DEVICE_ATTR_RO(outputs);

static ssize_t error_store(struct device *dev, struct device_attribute *attribute, const char *text, size_t size)
{
	int failed = kstrtoint(text, 10, &error);

	return failed ? failed : size;
}
static DEVICE_ATTR_WO(error);

static struct attribute *pwm_sim_attrs[] = { &dev_attr_outputs.attr, &dev_attr_error.attr, NULL };
ATTRIBUTE_GROUPS(pwm_sim);

static int pwm_sim_probe(struct platform_device *found)
{
	chip.dev = &found->dev;
	chip.ops = &pwm_sim_ops;
	chip.npwm = CHANNELS;
	return pwmchip_add(&chip);
}

static int pwm_sim_remove(struct platform_device *leaving)
{
	pwmchip_remove(&chip);
	return 0;
}

static struct platform_driver pwm_sim_driver = {
	.driver = { .name = "pwm-sim", .dev_groups = pwm_sim_groups },
	.probe = pwm_sim_probe,
	.remove = pwm_sim_remove,
};

static int __init pwm_sim_init(void)
{
	int failed = platform_driver_register(&pwm_sim_driver);

	if (failed)
		return failed;
	device = platform_device_register_simple("pwm-sim", PLATFORM_DEVID_NONE, NULL, 0);
	if (IS_ERR(device))
		platform_driver_unregister(&pwm_sim_driver);
	return PTR_ERR_OR_ZERO(device);
}
module_init(pwm_sim_init);

static void __exit pwm_sim_exit(void)
{
	platform_device_unregister(device);
	platform_driver_unregister(&pwm_sim_driver);
}
module_exit(pwm_sim_exit);

MODULE_DESCRIPTION("PWM chip without hardware");
MODULE_LICENSE("GPL");
