"""A Modbus slave by pymodbus: unit 7, holding registers 10 to 19, input registers 20 and 21, coils 3 and 4.

Usage: pymodbus_slave.py rtu PORT | tcp NUMBER. Prints "ready" before it listens.
"""
import sys

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server import StartSerialServer, StartTcpServer
from pymodbus.transaction import ModbusRtuFramer, ModbusSocketFramer

device = ModbusSlaveContext(
    di=ModbusSequentialDataBlock(0, [False]),
    co=ModbusSequentialDataBlock(3, [False, False]),
    hr=ModbusSequentialDataBlock(10, [0x1234, 0x5678] + [0] * 8),
    ir=ModbusSequentialDataBlock(20, [0x1234, 0xFFFE]),
    zero_mode=True,
)
context = ModbusServerContext(slaves={7: device}, single=False)
print("ready", flush=True)
if sys.argv[1] == "rtu":
    StartSerialServer(context=context, framer=ModbusRtuFramer, port=sys.argv[2], baudrate=19200,
                      parity="N", ignore_missing_slaves=True)
else:
    StartTcpServer(context=context, framer=ModbusSocketFramer, address=("127.0.0.1", int(sys.argv[2])),
                   ignore_missing_slaves=True)
