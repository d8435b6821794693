// SPDX-License-Identifier: GPL-2.0 OR Apache-2.0
// An I2C adapter, /dev/i2c-7, whose wires lead to a program: whoever has /dev/i2c-sim open is asked for every transfer
// and says how it went. Nobody has it open: the adapter is unplugged (ENODEV). No answer: ETIMEDOUT after the time
// the adapter was given (I2C_TIMEOUT).
//
// read() waits for a transfer and gives one struct i2c_sim_request with the bytes of its writes behind it. write() takes
// the answer: an __s32, 0 or -errno, and after a 0 the bytes of its reads.
#include <linux/i2c.h>
#include <linux/miscdevice.h>
#include <linux/module.h>
#include <linux/mutex.h>
#include <linux/poll.h>
#include <linux/uaccess.h>
#include <linux/wait.h>

#define ADAPTER 7
#define MESSAGES 2
#define LONGEST 1024

struct i2c_sim_request {
	__u16 address;
	__u16 count;
	struct {
		__u16 is_read;
		__u16 length;
	} message[MESSAGES];
};

enum stage { IDLE, ASKED, TAKEN, ANSWERED };

static DEFINE_MUTEX(lock); /* of all below */
static DECLARE_WAIT_QUEUE_HEAD(changed);
static bool plugged;
static enum stage stage;
static struct i2c_msg *messages; /* of the transfer under way */
static int message_count;
static int result;

static int i2c_sim_transfer(struct i2c_adapter *adapter, struct i2c_msg *msgs, int count)
{
	int done;

	mutex_lock(&lock);
	if (!plugged) {
		mutex_unlock(&lock);
		return -ENODEV;
	}
	messages = msgs;
	message_count = count;
	stage = ASKED;
	mutex_unlock(&lock);
	wake_up_all(&changed);

	wait_event_timeout(changed, READ_ONCE(stage) == ANSWERED || !READ_ONCE(plugged), adapter->timeout);

	mutex_lock(&lock);
	done = stage == ANSWERED ? result : plugged ? -ETIMEDOUT : -ENODEV;
	stage = IDLE;
	messages = NULL;
	mutex_unlock(&lock);
	return done < 0 ? done : count;
}

static u32 i2c_sim_functions(struct i2c_adapter *adapter)
{
	return I2C_FUNC_I2C | I2C_FUNC_SMBUS_EMUL;
}

static const struct i2c_algorithm i2c_sim_algorithm = {
	.master_xfer = i2c_sim_transfer,
	.functionality = i2c_sim_functions,
};

static const struct i2c_adapter_quirks i2c_sim_quirks = {
	.max_num_msgs = MESSAGES,
	.max_write_len = LONGEST,
	.max_read_len = LONGEST,
};

static struct i2c_adapter adapter = {
	.owner = THIS_MODULE,
	.nr = ADAPTER,
	.name = "i2c-sim",
	.algo = &i2c_sim_algorithm,
	.quirks = &i2c_sim_quirks,
};

static int i2c_sim_open(struct inode *inode, struct file *file)
{
	int failed = 0;

	mutex_lock(&lock);
	if (plugged)
		failed = -EBUSY;
	plugged = true;
	mutex_unlock(&lock);
	return failed;
}

static int i2c_sim_release(struct inode *inode, struct file *file)
{
	mutex_lock(&lock);
	plugged = false;
	mutex_unlock(&lock);
	wake_up_all(&changed);
	return 0;
}

static int give_request(char __user *into, size_t room)
{
	struct i2c_sim_request request = { .address = messages[0].addr, .count = message_count };
	size_t size = sizeof(request);
	int i;

	if (room < sizeof(request) + MESSAGES * LONGEST)
		return -EINVAL;
	for (i = 0; i < message_count; i++) {
		request.message[i].is_read = !!(messages[i].flags & I2C_M_RD);
		request.message[i].length = messages[i].len;
		if (request.message[i].is_read)
			continue;
		if (copy_to_user(into + size, messages[i].buf, messages[i].len))
			return -EFAULT;
		size += messages[i].len;
	}
	if (copy_to_user(into, &request, sizeof(request)))
		return -EFAULT;
	stage = TAKEN;
	return size;
}

static ssize_t i2c_sim_read(struct file *file, char __user *into, size_t room, loff_t *at)
{
	ssize_t size = -EAGAIN;

	while (size == -EAGAIN) {
		if (wait_event_interruptible(changed, READ_ONCE(stage) == ASKED))
			return -ERESTARTSYS;
		mutex_lock(&lock);
		if (stage == ASKED)
			size = give_request(into, room);
		mutex_unlock(&lock);
	}
	return size;
}

static int take_answer(const char __user *from, size_t size)
{
	size_t used = sizeof(__s32);
	__s32 code;
	int i;

	if (size < used || copy_from_user(&code, from, used))
		return -EFAULT;
	for (i = 0; code == 0 && i < message_count; i++) {
		if (!(messages[i].flags & I2C_M_RD))
			continue;
		if (size < used + messages[i].len || copy_from_user(messages[i].buf, from + used, messages[i].len))
			return -EFAULT;
		used += messages[i].len;
	}
	result = code;
	stage = ANSWERED;
	return 0;
}

static ssize_t i2c_sim_write(struct file *file, const char __user *from, size_t size, loff_t *at)
{
	int failed = -ETIMEDOUT; /* nobody waits for it any more */

	mutex_lock(&lock);
	if (stage == TAKEN)
		failed = take_answer(from, size);
	mutex_unlock(&lock);
	wake_up_all(&changed);
	return failed ? failed : size;
}

static __poll_t i2c_sim_poll(struct file *file, poll_table *table)
{
	poll_wait(file, &changed, table);
	return READ_ONCE(stage) == ASKED ? EPOLLIN | EPOLLRDNORM : 0;
}

static const struct file_operations i2c_sim_file = {
	.owner = THIS_MODULE,
	.open = i2c_sim_open,
	.release = i2c_sim_release,
	.read = i2c_sim_read,
	.write = i2c_sim_write,
	.poll = i2c_sim_poll,
};

static struct miscdevice i2c_sim_node = {
	.minor = MISC_DYNAMIC_MINOR,
	.name = "i2c-sim",
	.fops = &i2c_sim_file,
};

static int __init i2c_sim_init(void)
{
	int failed = i2c_add_numbered_adapter(&adapter);

	if (failed)
		return failed;
	failed = misc_register(&i2c_sim_node);
	if (failed)
		i2c_del_adapter(&adapter);
	return failed;
}
module_init(i2c_sim_init);

static void __exit i2c_sim_exit(void)
{
	misc_deregister(&i2c_sim_node);
	i2c_del_adapter(&adapter);
}
module_exit(i2c_sim_exit);

MODULE_DESCRIPTION("I2C adapter whose wires lead to a program");
MODULE_LICENSE("GPL");
